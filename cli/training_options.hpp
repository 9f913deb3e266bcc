// What every `actformer train` command takes and shows.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "model/train/config.hpp"
#include "model/train/training_events.hpp"

namespace actformer::cli {

struct TrainingOptions {
    std::string config, data, run;
    std::vector<std::string> overrides;
    bool json = false;

    /// The configuration file, the overrides on top, and --data on top of both.
    model::Config read(model::Config blank) const;
};

/// `options` must outlive the command.
void add_training_options(CLI::App* command, TrainingOptions& options);

/// Progress, epochs, scores and notes on standard error. Outlives the training.
class TrainingDisplay {
  public:
    explicit TrainingDisplay(std::int64_t epochs) : epochs_(epochs), progress_("train", "steps") {}
    model::TrainingEvents events();
    void clear() { progress_.clear(); }

  private:
    void print_epoch(const model::EpochReport& report);

    std::int64_t epochs_;
    Progress progress_;
};

/// Scores in a line, as in "accuracy 93.0 %  fid_whole 1.234".
std::string text_of(const nlohmann::ordered_json& scores);

}  // namespace actformer::cli
