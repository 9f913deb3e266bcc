// actformer import: weights that others released, read without running anything.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/files/nearest_file.hpp"
#include "base/text/counted.hpp"
#include "cli/commands.hpp"
#include "cli/common_options.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "ingest/export/foreign.hpp"
#include "model/generators/import_generator.hpp"
#include "model/recognisers/import_recogniser.hpp"

namespace actformer::cli {
namespace {

void print(bool json, const std::string& file, const std::string& what, std::uint64_t numbers,
           std::uint32_t classes) {
    if (json)
        say_json(nlohmann::ordered_json{
            {"file", file}, {"kind", what}, {"parameters", numbers}, {"classes", classes}});
    else
        say("{}: {}, {} in {}\n", file, what, counted(numbers, "number"), counted(classes, "class"));
}

template <typename Request>
struct ImportOptions {
    Request request;
    bool force = false, json = false;

    void refuse_foreign() const {
        if (!force) ingest::refuse_foreign_weights(request.out);
    }
};

/// Options that both have.
template <typename Request>
void add_files(CLI::App* command, ImportOptions<Request>& options) {
    auto& request = options.request;
    command
        ->add_option("file", request.file,
                     "A state_dict, or a dict that holds state_dicts, saved by torch.save")
        ->required()
        ->check([](const std::string& file) {
            return std::filesystem::exists(file) ? ""
                                                 : fmt::format("no such file {}{}", file, did_you_mean(file));
        })
        ->type_name("FILE");
    command
        ->add_option("--data", request.data,
                     "Dataset whose skeleton, representation and classes the weights are for")
        ->required()
        ->type_name("DATASET");
    command->add_option("-o,--out", request.out, "HDF5 file to make")
        ->required()
        ->type_name("WEIGHTS.h5")
        ->check(ends_in(".h5"));
    command->add_flag("--force", options.force, "Replace a file that holds no imported weights");
    command->add_flag("--json", options.json, "Print the result as JSON");
}

void add_import_generator(CLI::App& parent) {
    auto options = std::make_shared<ImportOptions<model::ImportGeneratorRequest>>();
    auto* command = parent.add_subcommand("generator", "A released checkpoint of ACTOR or Action2Motion");
    add_files(command, *options);
    add_overrides(command, options->request.overrides, "Settings that the checkpoint does not tell");
    examples(command,
             "  actformer import generator checkpoint_5000.pth.tar --data humanact12 -o actor.h5\n"
             "  actformer generate --generator actor.h5 -o motions.h5 --frames 60\n"
             "  actformer import generator narrow.pt --data humanact12 -o narrow.h5 heads=2\n"
             "ACTOR's released weights move in the camera's frame, y down, as a dataset does that was "
             "ingested with "
             "--published.\n");
    command->callback([options] {
        options->refuse_foreign();
        const auto made = model::import_generator(options->request);
        print(options->json, options->request.out.string(), made.method, made.numbers, made.classes);
    });
}

void add_import_recogniser(CLI::App& parent) {
    auto options = std::make_shared<ImportOptions<model::ImportRecogniserRequest>>();
    auto* command = parent.add_subcommand("recogniser", "An ST-GCN, or Action2Motion's GRU classifier");
    add_files(command, *options);
    examples(command,
             "  actformer import recogniser humanact12_gru.tar --data humanact12 -o gru.h5\n"
             "  actformer features --recogniser gru.h5 humanact12 -o features.h5\n");
    command->callback([options] {
        options->refuse_foreign();
        const auto made = model::import_recogniser(options->request);
        print(options->json, options->request.out.string(), made.kind, made.numbers, made.classes);
    });
}

}  // namespace

void add_import(CLI::App& app) {
    auto* command = app.add_subcommand("import", "Convert released PyTorch weights for this program");
    command->require_subcommand(1);
    add_import_generator(*command);
    add_import_recogniser(*command);
}

}  // namespace actformer::cli
