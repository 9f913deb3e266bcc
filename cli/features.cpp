// actformer features: what the recogniser sees in motions, for scoring.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/format.hpp"
#include "cli/progress.hpp"
#include "eval/scoring/features.hpp"
#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::cli {
namespace {

struct Options {
    eval::FeaturesRequest request;
    std::string device;
    bool json = false;
};

void print(const Options& options, const eval::FeaturesSummary& s) {
    if (options.json) {
        nlohmann::ordered_json out = {{"file", options.request.out.string()},
                                      {"sequences", s.sequences},
                                      {"features", s.features},
                                      {"classes", s.classes},
                                      {"labelled", s.labelled}};
        if (s.accuracy) out["accuracy"] = *s.accuracy;
        fmt::print("{}\n", out.dump(2));
        return;
    }
    fmt::print(
        "{}: {} of {} features and {} logits{}\n", options.request.out.string(),
        counted(s.sequences, "sequence"), s.features, s.classes,
        s.accuracy ? fmt::format("; {:.1f} % recognised as labelled", 100 * *s.accuracy) : "; no labels");
}

void run(const Options& options) {
    auto request = options.request;
    if (std::filesystem::is_directory(request.input)) {
        const auto folders = ingest::datasets_at(request.input);
        if (folders.size() != 1)
            throw Error("{}: holds {} datasets; take one at a time, as in {}", request.input.string(),
                        folders.size(), folders[0].string());
        request.input = folders[0];
    }
    request.recogniser = eval::weights_of(request.recogniser);
    kernels::Device device(options.device);
    Progress progress("features", "sequences", options.json);
    const auto summary = eval::make_features(request, device, [&](std::uint64_t done, std::uint64_t all) {
        progress.update(static_cast<double>(done) / static_cast<double>(all), done);
    });
    progress.clear();
    print(options, summary);
}

}  // namespace

void add_features(CLI::App& app) {
    auto options = std::make_shared<Options>();
    auto* command = app.add_subcommand("features", "Features and logits of motions or of a dataset's split");
    auto& request = options->request;
    command->add_option("--recogniser", request.recogniser, "Folder of its training, or its weights")
        ->required()
        ->type_name("RUN|WEIGHTS.h5");
    command->add_option("input", request.input, "Motions file in the public layout, or dataset folder")
        ->required()
        ->type_name("INPUT");
    command->add_option("-o,--out", request.out, "HDF5 file to make")->required()->type_name("FEATURES.h5");
    command->add_option("--frames", request.frames, "Take the first N frames of every motion (default: all)")
        ->check(CLI::Range(1, 1'000'000));
    command->add_option("--split", request.split, "Split of the dataset")->capture_default_str();
    command->add_option("--window", request.window, "Frames of the windows that a dataset is cut into")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    command->add_option("--batch", request.batch, "Sequences handed to the device together")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    command->add_option("--device", options->device, "OpenCL device: a number, gpu, cpu, or part of a name");
    command->add_flag("--json", options->json, "Print JSON");
    examples(command,
             "  actformer features --recogniser run generated.h5 -o generated-features.h5\n"
             "  actformer features --recogniser run ntu/ntu-1p --split xsub/test -o real.h5\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
