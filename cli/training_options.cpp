#include "cli/training_options.hpp"

#include <fmt/format.h>

#include "cli/common_options.hpp"
#include "cli/say.hpp"
#include "cli/shipped_option.hpp"

namespace actformer::cli {

model::Config TrainingOptions::read(model::Config blank) const {
    blank.load(config);
    for (const auto& assignment : overrides) blank.override_with(assignment);
    if (!data.empty()) blank.override_with("data=" + data);
    return blank;
}

void add_training_options(CLI::App* command, TrainingOptions& options) {
    takes_shipped(command->add_option("-c,--config", options.config,
                                      "Configuration: a file, or one that comes with the program, as "
                                      "`actformer model` lists them"),
                  "model/configs")
        ->required()
        ->type_name("CONFIG.yaml");
    command->add_option("--data", options.data, "Dataset folder; overrides the configuration's data:")
        ->type_name("DATASET");
    command->add_option("-o,--out", options.run, "Folder of this training")->required()->type_name("RUN");
    add_overrides(command, options.overrides, "As in batch=32: overrides the configuration");
    command->add_flag("--json", options.json, "Print the result as JSON");
}

std::string text_of(const nlohmann::ordered_json& scores) {
    std::string line;
    for (const auto& [key, value] : scores.items()) {
        if (!value.is_number()) continue;
        if (!line.empty()) line += "  ";
        if (key.ends_with("accuracy"))
            line += fmt::format("{} {:.1f} %", key, 100 * value.get<double>());
        else
            line += fmt::format("{} {:.3f}", key, value.get<double>());
    }
    return line;
}

void TrainingDisplay::print_epoch(const model::EpochReport& report) {
    std::string line = fmt::format("epoch {:>4} of {}  step {:>6}", report.epoch, epochs_, report.step);
    for (const auto& loss : report.losses) {
        if (loss.key.ends_with("accuracy"))
            line += fmt::format("  {} {:5.1f} %", loss.label, 100 * loss.value);
        else if (loss.key.ends_with("rate"))
            line += fmt::format("  {} {:<7g}", loss.label, loss.value);
        else
            line += fmt::format("  {} {:7.4f}", loss.label, loss.value);
    }
    if (report.scores)
        line +=
            fmt::format("  {}{}", text_of(report.scores->values), report.scores->best ? " best" : "     ");
    remark("{}  {:.2f} steps/s, {:.0f} windows/s\n", line, report.steps_a_second, report.windows_a_second);
}

model::TrainingEvents TrainingDisplay::events() {
    model::TrainingEvents events;
    events.progress = [this](double fraction, std::uint64_t steps) { progress_.update(fraction, steps); };
    events.note = [this](const std::string& line) {
        progress_.clear();
        remark("{}\n", line);
    };
    events.epoch = [this](const model::EpochReport& report) {
        progress_.clear();
        print_epoch(report);
    };
    events.scores = [this](const model::ValidationReport& scores) {
        progress_.clear();
        remark("epoch {:>4}: {}{}\n", scores.epoch, text_of(scores.values), scores.best ? "  best" : "");
    };
    return events;
}

}  // namespace actformer::cli
