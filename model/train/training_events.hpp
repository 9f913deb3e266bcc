// What a training tells while it goes on, and what came of it. Knows nothing of torch.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace actformer::model {

/// A number that a training is watched by.
struct Measure {
    std::string key;    ///< in log.jsonl, as in "generator_loss"
    std::string label;  ///< in a terminal's line, as in "G"
    double value = 0;
};

using Measures = std::vector<Measure>;

/// The value under `key`, which must be there.
double value_of(const Measures& measures, const std::string& key);

/// Scores of the weights of some step.
struct ValidationReport {
    std::uint64_t epoch = 0, step = 0;
    nlohmann::ordered_json values;  ///< by key, as in log.jsonl
    bool best = false;              ///< of all so far
};

/// What an epoch came to: means over its steps, and over all processes.
struct EpochReport {
    std::uint64_t epoch = 0, step = 0;  ///< finished
    Measures losses;
    std::optional<ValidationReport> scores;  ///< where they do not come later
    double seconds = 0, steps_a_second = 0, windows_a_second = 0;
};

/// Progress callbacks; any of them may be empty.
struct TrainingEvents {
    std::function<void(double fraction, std::uint64_t steps)> progress;  ///< of the whole training
    std::function<void(const EpochReport&)> epoch;
    std::function<void(const ValidationReport&)> scores;  ///< those that come some steps after their epoch
    std::function<void(const std::string&)> note;         ///< one line
};

struct TrainingResult {
    std::uint64_t epochs = 0, steps = 0;
    std::optional<ValidationReport> best, last;                    ///< none where nothing was scored
    std::filesystem::path weights, average_weights, best_weights;  ///< empty where there are none
};

}  // namespace actformer::model
