// actformer model: the layers, shapes and parameter counts of a configuration's network.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/error.hpp"
#include "base/text/counted.hpp"
#include "cli/commands.hpp"
#include "cli/common_options.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "cli/shipped_option.hpp"
#include "eval/recogniser_kind.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/view.hpp"
#include "model/generators/method.hpp"
#include "model/recognisers/recogniser_settings.hpp"

namespace actformer::cli {
namespace {

struct ModelOptions {
    std::string config, data;
    std::vector<std::string> overrides;
    bool json = false;
};

struct Networks {
    std::vector<model::NetworkSummary> all;
    bool for_ntu = false;  ///< as no dataset is named
};

/// Empty where neither the configuration nor --data names a dataset.
std::string data_of(const model::Config& config, const ModelOptions& options) {
    return options.data.empty() ? config.get<std::string>("data") : options.data;
}

/// What networks are made for: a dataset, or NTU's skeleton with the configuration's persons and classes.
model::MotionSpec spec_of(const model::Config& config, const ModelOptions& options) {
    const auto data = data_of(config, options);
    if (!data.empty()) {
        const ingest::Dataset dataset(ingest::one_dataset_at(data));
        return model::spec_of(ingest::subjects_of(dataset), dataset.folder().string());
    }
    const auto persons = config.get<std::int64_t>("persons"), classes = config.get<std::int64_t>("classes");
    if (persons == 0 || classes == 0)
        throw Error(
            "{}: leaves persons or classes to the dataset; give --data DATASET, or persons=1 classes=94",
            options.config);
    return {ingest::Representation::limb, ingest::ntu25(), static_cast<std::uint32_t>(persons),
            static_cast<std::uint32_t>(classes), options.config};
}

std::int64_t parameters_of(const model::NetworkSummary& network) {
    return std::accumulate(network.lines.begin(), network.lines.end(), std::int64_t{0},
                           [](std::int64_t sum, const auto& line) { return sum + line.parameters; });
}

model::Config read(model::Config config, const ModelOptions& options) {
    config.load(options.config);
    for (const auto& assignment : options.overrides) config.override_with(assignment);
    return config;
}

model::NetworkSummary recogniser_of(const model::Config& config, const model::MotionSpec& spec) {
    const auto settings = model::recogniser_settings(config);
    const auto joints = settings.joints_seen();
    const auto representation = ingest::representation_seen(spec.representation, joints);
    const auto& topology = ingest::topology_seen(spec.topology, joints);
    if (settings.kind == model::RecogniserKind::gru)
        return {"recogniser", model::gru_summary(model::gru_for(settings, representation, topology,
                                                                spec.persons, spec.classes, spec.where),
                                                 settings.frames)};
    const auto network =
        model::stgcn_for(settings, representation, topology, spec.persons, spec.classes, spec.where);
    return {"recogniser", model::stgcn_summary(network, settings.frames)};
}

Networks networks_of(const ModelOptions& options) {
    if (const auto kind = eval::recogniser_kind_named(model::model_named_in(options.config))) {
        const auto config = read(model::recogniser_config(*kind), options);
        return {{recogniser_of(config, spec_of(config, options))}, data_of(config, options).empty()};
    }
    const auto config = read(model::read_generator_config(options.config), options);
    const auto& method = model::method_named(config.model(), options.config);
    return {method.networks(config, spec_of(config, options)), data_of(config, options).empty()};
}

std::string shape_text(const std::vector<std::int64_t>& shape) {
    return fmt::format("({})", fmt::join(shape, ", "));
}

/// A table whose columns are as wide as their longest entries.
void print_network(const model::NetworkSummary& network) {
    std::vector<std::array<std::string, 4>> rows{{network.name, "what", "output", "parameters"}};
    for (const auto& line : network.lines)
        rows.push_back({line.layer, line.kind, shape_text(line.shape),
                        grouped(static_cast<std::uint64_t>(line.parameters))});
    rows.push_back({"total", "", "", grouped(static_cast<std::uint64_t>(parameters_of(network)))});
    std::array<std::size_t, 4> widths{24, 40, 16, 12};
    for (const auto& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    for (const auto& row : rows)
        say("{:<{}} {:<{}} {:<{}} {:>{}}\n", row[0], widths[0], row[1], widths[1], row[2], widths[2], row[3],
            widths[3]);
    say("\n");
}

void print_text(const Networks& networks) {
    if (networks.for_ntu) say("for NTU's 25 joints, as no --data is given\n\n");
    for (const auto& network : networks.all) print_network(network);
}

void print_json(const std::vector<model::NetworkSummary>& networks) {
    nlohmann::ordered_json out;
    std::int64_t all = 0;
    for (const auto& network : networks) {
        auto layers = nlohmann::ordered_json::array();
        for (const auto& line : network.lines)
            layers.push_back({{"layer", line.layer},
                              {"what", line.kind},
                              {"output", line.shape},
                              {"parameters", line.parameters}});
        if (networks.size() == 1)
            out["layers"] = layers;
        else
            out[network.name] = {{"layers", layers}, {"parameters", parameters_of(network)}};
        all += parameters_of(network);
    }
    out["parameters"] = all;
    say_json(out);
}

void run(const ModelOptions& options) {
    const auto networks = networks_of(options);
    options.json ? print_json(networks.all) : print_text(networks);
}

}  // namespace

void add_model(CLI::App& app) {
    auto options = std::make_shared<ModelOptions>();
    auto* command =
        app.add_subcommand("model", "Print a configuration's layers, output shapes and parameter counts");
    takes_shipped(
        command->add_option("config", options->config,
                            "Configuration: a file, or the name of one that comes with the program"),
        "model/configs")
        ->required()
        ->type_name("CONFIG.yaml");
    lists_shipped(command, "model/configs");
    command->add_option("--data", options->data, "Dataset whose joints, persons and classes to take")
        ->type_name("DATASET");
    add_overrides(command, options->overrides, "As in width=0.5");
    command->add_flag("--json", options->json, "Print JSON");
    examples(command,
             "  actformer model                                        which configurations come with it\n"
             "  actformer model recogniser-ntu-1p\n"
             "  actformer model actformer-ntu-2p frames=64\n"
             "  actformer model mine.yaml --data bnr10 width=0.5\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
