// actformer export: a dataset or one split of it in the public ActFormer layout.
#include <fmt/format.h>

#include "base/error.hpp"
#include "cli/commands.hpp"
#include "cli/format.hpp"
#include "cli/progress.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"

namespace actformer::cli {
namespace {

struct Options {
    std::string dataset, out, split = "all";
};

void run(const Options& options) {
    const auto folders = ingest::datasets_at(options.dataset);
    if (folders.size() != 1)
        throw Error("{}: holds {} datasets; export one at a time, as in {}", options.dataset, folders.size(),
                    folders[0].string());
    const ingest::Dataset dataset(folders[0]);
    const auto clips = dataset.split(options.split);
    if (clips.empty()) throw Error("{}: split {} holds no clip", options.dataset, options.split);

    Progress progress("export", "clips");
    ingest::MotionsWriter writer(options.out);
    writer.describe(ingest::subjects_of(dataset));
    for (std::size_t i = 0; i < clips.size(); ++i) {
        const auto& clip = dataset.clips()[clips[i]];
        writer.add(ingest::public_name(clip.name, clip.label), dataset.motion(clips[i]));
        progress.update(static_cast<double>(i + 1) / static_cast<double>(clips.size()), i + 1);
    }
    writer.finish();
    progress.clear();
    fmt::print("{}: {} of split {}, each ({}, {}, frames)\n", options.out, counted(clips.size(), "clip"),
               options.split, dataset.header().persons * dataset.header().representation.numbers(),
               dataset.header().nodes());
}

}  // namespace

void add_export(CLI::App& app) {
    auto options = std::make_shared<Options>();
    auto* command =
        app.add_subcommand("export", "Write a dataset in the public layout: one (P*C, K, T) array a clip");
    command->add_option("dataset", options->dataset, "Dataset folder")->required()->type_name("DATASET");
    command->add_option("-o,--out", options->out, "HDF5 file to make")->required()->type_name("FILE.h5");
    command->add_option("--split", options->split, "As in xsub/train (default: all clips)");
    examples(command, "  actformer export ntu/ntu-1p -o ntu1p-xsub-train.h5 --split xsub/train\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
