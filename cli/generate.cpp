// actformer generate: motions out of a trained generator.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "base/text/counted.hpp"
#include "cli/commands.hpp"
#include "cli/common_options.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "ingest/export/foreign.hpp"
#include "model/generators/generate.hpp"

namespace actformer::cli {
namespace {

struct GenerateOptions {
    model::GenerateRequest request;
    bool force = false, json = false;
};

void run(const GenerateOptions& options) {
    if (!options.force) ingest::refuse_foreign(options.request.out);
    Progress progress("generate", "motions", options.json);
    const auto made = model::generate(options.request, [&](std::uint64_t done, std::uint64_t all) {
        progress.update(static_cast<double>(done) / static_cast<double>(all), done);
    });
    progress.clear();
    const auto file = options.request.out.string();
    if (options.json)
        say_json(nlohmann::ordered_json{{"file", file},
                                        {"motions", made.motions},
                                        {"classes", made.classes},
                                        {"persons", made.persons},
                                        {"numbers", made.numbers},
                                        {"nodes", made.nodes},
                                        {"frames", made.frames}});
    else
        say("{}: {} of {}, each ({}, {}, {})\n", file, counted(made.motions, "motion"),
            counted(made.classes, "class"), made.persons * made.numbers, made.nodes, made.frames);
}

}  // namespace

void add_generate(CLI::App& app) {
    auto options = std::make_shared<GenerateOptions>();
    auto& request = options->request;
    auto* command = app.add_subcommand("generate", "Generate motions with a trained generator");
    command->add_option("--generator", request.generator, "Folder of its training, or its weights")
        ->required()
        ->type_name("RUN|WEIGHTS.h5");
    command->add_option("-o,--out", request.out, "HDF5 file to make, in the public layout")
        ->required()
        ->type_name("MOTIONS.h5")
        ->check(ends_in(".h5"));
    command->add_option("--per-class", request.per_class, "Motions of every class")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    command
        ->add_option("--classes", request.classes,
                     "Classes by name or by number from 1, as in walk,3 (default: all)")
        ->delimiter(',')
        ->type_name("LIST");
    command->add_option("--seed", request.seed, "Random seed")->capture_default_str();
    command->add_option("--frames", request.frames, "Frames a motion (default: as it was trained)")
        ->check(CLI::Range(1, 4096));
    command->add_option("--device", request.device, "Where libtorch works: cpu, cuda or cuda:N")
        ->capture_default_str();
    command
        ->add_option("--threads", request.threads, "Processor threads (default: OMP_NUM_THREADS, else all)")
        ->check(CLI::Range(1U, most_threads));
    command->add_flag("--force", options->force, "Replace a file that this program did not write");
    command->add_flag("--json", options->json, "Print JSON");
    examples(command,
             "  actformer generate --generator run -o generated.h5\n"
             "  actformer generate --generator run/weights-last.h5 -o few.h5 --classes 1,3 --per-class 4 "
             "--seed 7\n"
             "  actformer render few.h5 --per-class 4 -o few.gif\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
