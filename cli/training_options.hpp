// What every `actformer train` command takes.
#pragma once

#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "model/train/config.hpp"

namespace actformer::cli {

struct TrainingOptions {
    std::string config, data, run;
    std::vector<std::string> overrides;
    bool json = false;

    /// The configuration file, the overrides on top, and --data on top of both.
    model::Config read(model::Config blank) const {
        blank.load(config);
        for (const auto& assignment : overrides) blank.override_with(assignment);
        if (!data.empty()) blank.override_with("data=" + data);
        return blank;
    }
};

/// `options` must outlive the command.
inline void add_training_options(CLI::App* command, TrainingOptions& options) {
    command->add_option("-c,--config", options.config, "Configuration, as in model/configs")
        ->required()
        ->type_name("CONFIG.yaml");
    command->add_option("--data", options.data, "Dataset folder, before the configuration's data:")
        ->type_name("DATASET");
    command->add_option("-o,--out", options.run, "Folder of this training")->required()->type_name("RUN");
    command->add_option("overrides", options.overrides, "As in batch=32, before the configuration's")
        ->type_name("KEY=VALUE");
    command->add_flag("--json", options.json, "Print the result as JSON");
}

}  // namespace actformer::cli
