// actformer export: clips for other programs.
#include "ingest/export/export.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/text/counted.hpp"
#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "ingest/export/export_format.hpp"

namespace actformer::cli {
namespace {

struct ExportOptions {
    ingest::ExportRequest request;
    bool json = false;
};

void print_text(const ingest::ExportSummary& summary, const ExportOptions& options) {
    const auto folder = summary.files.size() != 1 || summary.files[0] != options.request.out;
    say("{}: {}, {}{}\n", options.request.out.string(), counted(summary.clips, "clip"),
        counted(summary.frames, "frame"), folder ? ", " + counted(summary.files.size(), "file") : "");
    for (const auto& note : summary.notes) say("  {}\n", note);
}

void print_json(const ingest::ExportSummary& summary) {
    nlohmann::ordered_json json{{"format", summary.format}, {"representation", summary.representation},
                                {"clips", summary.clips},   {"frames", summary.frames},
                                {"notes", summary.notes},   {"files", nlohmann::ordered_json::array()}};
    for (const auto& file : summary.files) json["files"].push_back(file.string());
    say_json(json);
}

void run(const ExportOptions& options) {
    Progress progress("export", "clips", options.json);
    const auto summary = ingest::export_clips(options.request, [&](std::size_t done, std::size_t all) {
        progress.update(static_cast<double>(done) / static_cast<double>(all), done);
    });
    progress.clear();
    options.json ? print_json(summary) : print_text(summary, options);
}

std::string formats(const std::string& before) {
    std::string text;
    for (const auto& format : ingest::export_formats())
        text += fmt::format("{}{}{} ({})", text.empty() ? "" : "; ", before, format.name, format.holds);
    return text;
}

/// As in "{h5,npz}", which completions offer.
std::string format_names() {
    std::vector<std::string> names;
    for (const auto& format : ingest::export_formats()) names.emplace_back(format.name);
    return fmt::format("{{{}}}", fmt::join(names, ","));
}

}  // namespace

void add_export(CLI::App& app) {
    auto options = std::make_shared<ExportOptions>();
    auto& request = options->request;
    auto& selection = request.selection;
    auto* command = app.add_subcommand("export", "Write motions for other programs: .h5, .npz, .bvh, .glb");
    command->add_option("input", request.input, "Dataset folder, or motions as generate makes them")
        ->required()
        ->type_name("DATASET|MOTIONS.h5");
    command
        ->add_option(
            "-o,--out", request.out,
            "File to make, of a kind told by its ending: " + formats(".") + ". Or a folder, with --format")
        ->required()
        ->type_name("OUT");
    command
        ->add_option("--format", request.format,
                     "Make a folder with a file a clip of this kind, named after it (CLIP.bvh, CLIP_p1.bvh "
                     "of several persons)")
        ->type_name("KIND:" + format_names());
    command->add_option("--split", selection.split, "As in xsub/train (default: all clips)");
    command->add_option("--class", selection.label, "Clips of this class: its name, or its number from 1");
    command->add_option("--clip", selection.clips, "This clip; may be given again")->allow_extra_args(false);
    command->add_option("--count", selection.count, "Number of clips, evenly spaced (default: all)")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 40));
    command->add_option("--person", selection.person, "This person alone, a number from 1 (default: all)")
        ->check(CLI::Range(1U, 1'000'000U));
    command
        ->add_option("--bones", request.bones,
                     "Dataset whose skeleton and mean limb lengths motions get in place of their file's own")
        ->type_name("DATASET");
    command
        ->add_option("--body", request.body,
                     "SMPL's model file: its mean body as the skin of a .glb, on rotations of SMPL's joints")
        ->type_name("FILE");
    command->add_flag("--force", request.force, "Replace files that this program did not write");
    command->add_flag("--json", options->json, "Print JSON");
    examples(command,
             "  actformer export ntu/ntu-1p -o xsub-train.h5 --split xsub/train\n"
             "  actformer export ntu/ntu-2p -o joints.npz\n"
             "  actformer export ntu/ntu-2p -o handshake.glb --class \"shaking hands\" --count 1\n"
             "  actformer export generated.h5 -o walks/ --format bvh --class walk\n"
             "  actformer export generated.h5 -o dance.glb --class dance --count 1 --body SMPL_NEUTRAL.pkl\n"
             "Clips of generate are called A001_0, by the number of their class: `ingest bvh walks --name "
             "'A{action}_{index}'` reads such files back.\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
