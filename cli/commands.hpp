// The commands of `actformer`, one file each.
#pragma once

#include <CLI/CLI.hpp>

namespace actformer::cli {

void add_devices(CLI::App& app);
void add_synth(CLI::App& app);
void add_ingest(CLI::App& app);
void add_inspect(CLI::App& app);
void add_export(CLI::App& app);
void add_render(CLI::App& app);
void add_features(CLI::App& app);
void add_classify(CLI::App& app);
void add_score(CLI::App& app);
void add_sweep(CLI::App& app);
void add_compare(CLI::App& app);
void add_report(CLI::App& app);
void add_bench(CLI::App& app);
void add_train(CLI::App& app);
void add_train_recogniser(CLI::App& train);
void add_train_generator(CLI::App& train);
void add_check_trainings(CLI::App& train);
void add_generate(CLI::App& app);
void add_import(CLI::App& app);
void add_model(CLI::App& app);

/// More threads than this help no work here, and may be more than a machine has for all that runs on it.
constexpr unsigned most_threads = 1024;

/// Ends a command's --help with lines that can be typed as they stand.
inline void examples(CLI::App* command, const std::string& lines) {
    command->footer("Examples:\n" + lines);
}

}  // namespace actformer::cli
