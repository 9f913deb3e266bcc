// The training loop: steps and epochs of a learner in a run folder, resumable to the bit, validated during training, by one process or
// several. Includes torch headers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/dataset.hpp"
#include "model/train/trainer_settings.hpp"
#include "model/train/training_events.hpp"
#include "model/train/validator.hpp"

namespace actformer::model {

/// What is trained, beside the learner.
struct TrainingTask {
    std::string model;  ///< whose checkpoints these are: "recogniser", or a generator's method
    const Config& config;
    TrainerSettings settings;
    const ingest::Dataset& dataset;

    /// Writes weights, whole or not at all, with notes as text attributes. Throws Error where they cannot be written.
    std::function<void(const std::filesystem::path& path, const std::vector<Array>& weights,
                       const std::map<std::string, std::string>& notes)>
        save_weights;
};

/// Trains in the folder `run`, going on behind its newest whole checkpoint: the weights come out as they would have without
/// the interruption, bit for bit on as many threads. Writes config.yaml, log.jsonl, the last two checkpoints,
/// weights-last.h5, weights-average.h5 where the learner keeps an EMA, and with a validator, which may be null, weights-best.h5.
/// An epoch is as many windows as there are clips. What cannot be written is told, and training goes on; lines of the log are kept, and
/// no checkpoint is behind them until they are written. Throws Error where the last of it cannot be written.
///
/// Of several processes rank 0 alone writes, scores and tells.
///
/// Throws Error where another training holds the folder, or one of other settings or data is in it; and where losses
/// or weights are NaN or infinite, or the learner is in trouble for long, the last checkpoint before that being kept.
TrainingResult train(const TrainingTask& task, Learner& learner, const LearnerSetup& setup,
                     Validator* validator, const std::filesystem::path& run, const TrainingEvents& events);

}  // namespace actformer::model
