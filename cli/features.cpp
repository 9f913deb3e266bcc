// actformer features: what the recogniser sees in motions, for scoring.
#include "eval/scoring/features.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/text/counted.hpp"
#include "cli/commands.hpp"
#include "cli/common_options.hpp"
#include "cli/motion_options.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "eval/scoring/features_file.hpp"
#include "ingest/export/foreign.hpp"

namespace actformer::cli {
namespace {

struct FeaturesOptions : MotionOptions {
    std::filesystem::path out;
    std::optional<std::uint64_t> initial_noise;
    bool force = false, json = false;
};

void print(const FeaturesOptions& options, const eval::FeaturesSummary& s) {
    if (options.json) {
        nlohmann::ordered_json out = {{"file", options.out.string()},
                                      {"sequences", s.sequences},
                                      {"features", s.features},
                                      {"classes", s.classes},
                                      {"labelled", s.labelled}};
        if (s.accuracy) out["accuracy"] = *s.accuracy;
        say_json(out);
        return;
    }
    say("{}: {} of {} features and {} logits{}\n", options.out.string(), counted(s.sequences, "sequence"),
        s.features, s.classes,
        s.accuracy ? fmt::format("; {:.1f} % recognised as labelled", 100 * *s.accuracy) : "; no labels");
}

void run(const FeaturesOptions& options) {
    if (!options.force)
        ingest::refuse_foreign(options.out, "features",
                               [&](std::string_view) { return eval::is_own_features(options.out); });
    kernels::Device device(options.device);
    eval::FeatureExtractor extractor(device, options.recogniser, options.batch,
                                     eval::FeatureExtractor::Persons::together, options.initial_noise);
    const auto motions = options.open(device, extractor);
    Progress progress("features", "sequences", options.json);
    const eval::FeaturesTarget target{&extractor, options.out};
    const auto summary =
        eval::write_features(*motions, std::span(&target, 1), [&](std::uint64_t done, std::uint64_t all) {
            progress.update(static_cast<double>(done) / static_cast<double>(all), done);
        });
    progress.clear();
    print(options, summary);
}

}  // namespace

void add_features(CLI::App& app) {
    auto options = std::make_shared<FeaturesOptions>();
    auto* command = app.add_subcommand("features", "Features and logits of motions or of a dataset's split");
    add_motion_options(command, *options);
    command->add_option("-o,--out", options->out, "HDF5 file to make")
        ->required()
        ->type_name("FEATURES.h5")
        ->check(ends_in(".h5"));
    command
        ->add_option(
            "--initial-noise", options->initial_noise,
            "Seed of the states that a GRU recogniser begins with, as published (default: they begin at 0)")
        ->type_name("SEED");
    add_force_option(command, options->force);
    command->add_flag("--json", options->json, "Print JSON");
    examples(command,
             "  actformer features --recogniser run generated.h5 -o generated-features.h5\n"
             "  actformer features --recogniser run ntu/ntu-1p --split xsub/test -o real.h5\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
