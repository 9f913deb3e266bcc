// actformer model: the layers, shapes and parameter counts of a configuration's network.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "cli/commands.hpp"
#include "cli/format.hpp"
#include "ingest/dataset.hpp"
#include "kernels/error.hpp"
#include "model/recogniser_settings.hpp"

namespace actformer::cli {
namespace {

struct Options {
    std::string config, data;
    std::vector<std::string> overrides;
    bool json = false;
};

/// Of the dataset where there is one, else of NTU's skeleton with the configuration's persons and classes.
model::StgcnSettings network_of(const model::RecogniserSettings& settings, const std::string& config) {
    if (!settings.data.empty()) {
        const auto folders = ingest::datasets_at(settings.data);
        if (folders.size() != 1)
            throw Error("{}: holds {} datasets; name one, as in {}", settings.data, folders.size(),
                        folders[0].string());
        const ingest::Dataset dataset(folders[0]);
        const auto& header = dataset.header();
        return model::network_for(settings, header.topology, header.persons, header.classes.size(),
                                  folders[0].string());
    }
    if (settings.persons == 0 || settings.classes == 0)
        throw Error(
            "{}: leaves persons or classes to the dataset; give --data DATASET, or persons=1 classes=94",
            config);
    return model::network_for(settings, ingest::ntu25(), settings.persons, settings.classes, config);
}

std::string shape_text(const std::vector<std::int64_t>& shape) {
    return fmt::format("({})", fmt::join(shape, ", "));
}

void print_text(const std::vector<model::SummaryLine>& lines, std::int64_t total) {
    fmt::print("{:<24} {:<34} {:<16} {:>12}\n", "layer", "what", "output", "parameters");
    for (const auto& line : lines)
        fmt::print("{:<24} {:<34} {:<16} {:>12}\n", line.layer, line.kind, shape_text(line.shape),
                   grouped(static_cast<std::uint64_t>(line.parameters)));
    fmt::print("{:<24} {:<34} {:<16} {:>12}\n", "total", "", "", grouped(static_cast<std::uint64_t>(total)));
}

void print_json(const std::vector<model::SummaryLine>& lines, std::int64_t total) {
    auto layers = nlohmann::ordered_json::array();
    for (const auto& line : lines)
        layers.push_back({{"layer", line.layer},
                          {"what", line.kind},
                          {"output", line.shape},
                          {"parameters", line.parameters}});
    fmt::print("{}\n", nlohmann::ordered_json{{"layers", layers}, {"parameters", total}}.dump(2));
}

void run(const Options& options) {
    auto config = model::recogniser_config();
    config.load(options.config);
    for (const auto& assignment : options.overrides) config.override_with(assignment);
    if (!options.data.empty()) config.override_with("data=" + options.data);
    const auto settings = model::recogniser_settings(config);
    const auto lines = model::stgcn_summary(network_of(settings, options.config), settings.frames);
    const auto total =
        std::accumulate(lines.begin(), lines.end(), std::int64_t{0},
                        [](std::int64_t sum, const auto& line) { return sum + line.parameters; });
    options.json ? print_json(lines, total) : print_text(lines, total);
}

}  // namespace

void add_model(CLI::App& app) {
    auto options = std::make_shared<Options>();
    auto* command =
        app.add_subcommand("model", "Print a configuration's layers, output shapes and parameter counts");
    command->add_option("config", options->config, "Configuration, as in model/configs")
        ->required()
        ->type_name("CONFIG.yaml");
    command->add_option("--data", options->data, "Dataset whose joints, persons and classes to take")
        ->type_name("DATASET");
    command->add_option("overrides", options->overrides, "As in width=0.5")->type_name("KEY=VALUE");
    command->add_flag("--json", options->json, "Print JSON");
    examples(command,
             "  actformer model model/configs/recogniser-ntu-1p.yaml\n"
             "  actformer model model/configs/recogniser-small.yaml --data bnr10 width=0.5\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
