// Training the recogniser (DESIGN 4.7): resumable to the bit, scored after every epoch.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "eval/metrics/confusion.hpp"
#include "model/recognisers/recogniser_settings.hpp"

namespace actformer::model {

/// What an epoch came to. Accuracies, 0..1, are of the test split's consecutive windows of T frames.
struct EpochReport {
    std::uint64_t epoch = 0;  ///< from 1
    double rate = 0, loss = 0;
    double train_accuracy = 0;   ///< share of the epoch's own drawn windows, under dropout
    bool scored = false;         ///< there is a test split
    double class_accuracy = 0;   ///< mean over its classes
    double sample_accuracy = 0;  ///< share of its windows
    double seconds = 0;          ///< of the training steps
    double windows_a_second = 0;
    bool best = false;  ///< of all epochs so far, by class_accuracy
};

/// Whom the training tells how it goes; any of them may be empty.
struct TrainingEvents {
    std::function<void(double fraction, std::uint64_t windows)> progress;  ///< of the whole training
    std::function<void(const EpochReport&)> epoch;
    std::function<void(const std::string&)> note;  ///< one line
};

struct TrainingResult {
    std::uint64_t epochs = 0, best_epoch = 0;  ///< best_epoch 0: none was scored
    double best_class_accuracy = 0;
    eval::Confusion confusion{0};  ///< of the test split after the last epoch
    std::vector<std::string> classes;
    std::filesystem::path last_weights, best_weights;  ///< best_weights empty where none was scored
};

/// Trains in the folder `run`, going on behind its newest whole checkpoint: the weights come out as they would
/// have without the interruption, bit for bit on as many threads. Writes config.yaml, log.jsonl, the last two checkpoints, weights-last.h5
/// and weights-best.h5. Throws Error where another training holds the folder, or one of other settings or data is in it.
TrainingResult train_recogniser(const Config& config, const std::filesystem::path& run,
                                const TrainingEvents& events);

}  // namespace actformer::model
