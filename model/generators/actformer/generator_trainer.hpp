// Training a generator (DESIGN 4.7): resumable to the bit, scored on the way, by one process or several.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "model/train/config.hpp"

namespace actformer::model {

/// What an epoch came to: means over its steps (and over all processes).
struct GeneratorEpoch {
    std::uint64_t epoch = 0,
                  step =
                      0;  ///< finished; a step is one of the generator's, with the discriminator's before it
    double discriminator_loss = 0, generator_loss = 0;
    double real_score = 0, made_score = 0;  ///< that the discriminator gives
    double seconds = 0, steps_a_second = 0;
};

/// Scores of generated motions (DESIGN 4.9), and whether they are the best so far, by fid_whole.
struct GeneratorScores {
    std::uint64_t epoch = 0, step = 0;
    double accuracy = 0, fid_whole = 0;  ///< accuracy 0..1
    std::optional<double> fid_mean;      ///< none where no class has one
    bool best = false;
};

/// Whom the training tells how it goes; any of them may be empty.
struct GeneratorEvents {
    std::function<void(double fraction, std::uint64_t steps)> progress;  ///< of the whole training
    std::function<void(const GeneratorEpoch&)> epoch;
    std::function<void(const GeneratorScores&)> scores;  ///< may come some steps after their epoch
    std::function<void(const std::string&)> note;        ///< one line
};

struct GeneratorResult {
    std::uint64_t epochs = 0, steps = 0;
    std::optional<GeneratorScores> best, last;  ///< none where nothing was scored
    std::optional<double> real_accuracy;  ///< of the recogniser on the real windows of the training's split
    std::filesystem::path weights, average_weights, best_weights;  ///< empty where there are none
};

/// Trains in the folder `run`, going on behind its newest whole checkpoint: the weights come out as they would have without
/// the interruption, bit for bit on one thread. Writes config.yaml, log.jsonl, the last two checkpoints, weights-last.h5,
/// with `average` weights-average.h5 and with `recogniser` weights-best.h5. An epoch is as many real windows as there are
/// clips. A checkpoint that cannot be written is told, and training goes on.
///
/// With `data_parallel`, as one of the processes that torchrun, mpirun or srun started (see place_of); rank 0 alone writes.
///
/// Throws Error where another training holds the folder, or one of other settings or data is in it; and where the losses
/// are no numbers or have collapsed, the last checkpoint before that being kept.
GeneratorResult train_generator(const Config& config, const std::filesystem::path& run, bool data_parallel,
                                const GeneratorEvents& events);

}  // namespace actformer::model
