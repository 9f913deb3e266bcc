// Training the recogniser, scored after every epoch.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "eval/metrics/confusion.hpp"
#include "model/recognisers/recogniser_settings.hpp"
#include "model/train/training_events.hpp"

namespace actformer::model {

struct RecogniserResult {
    TrainingResult training;
    eval::Confusion confusion{
        0};  ///< of the test split after the last epoch; of no samples where there is no such split
    std::vector<std::string> classes;
};

/// Trains as train() of model/train/trainer.hpp says. Losses are `loss` and `train_accuracy`, 0..1, of the epoch's own drawn
/// windows, under dropout. Scores, 0..1, are of the test split's consecutive windows of T frames: `class_accuracy`, the mean
/// over its classes, `sample_accuracy`, the share of its windows, and `confusion`.
RecogniserResult train_recogniser(const Config& config, const std::filesystem::path& run,
                                  const TrainingEvents& events);

}  // namespace actformer::model
