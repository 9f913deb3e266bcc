// actformer render: motions as a contact sheet, a GIF or an MP4.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "base/error.hpp"
#include "base/files/output.hpp"
#include "base/text/counted.hpp"
#include "cli/commands.hpp"
#include "cli/common_options.hpp"
#include "cli/format.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "reports/motions/gather.hpp"
#include "reports/pictures/camera.hpp"
#include "reports/pictures/render.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;
using reports::JointMotion;

struct RenderOptions {
    std::vector<fs::path> inputs;
    fs::path output, body;
    reports::Wanted wanted;
    std::string view = "three-quarter";
    int size = 0, columns = 8;
    double fps = 0;
};

void render(const RenderOptions& options) {
    const auto kind = reports::picture_kind(options.output);
    check_output(options.output);
    reports::Layout layout;
    layout.view = reports::parse_view(options.view);
    layout.columns = options.columns;
    layout.fps = options.fps;

    layout.across = static_cast<int>(options.wanted.per_class);  // a class a row

    auto wanted = options.wanted;
    if (!options.body.empty()) wanted.body = std::make_shared<const reports::BodySkin>(options.body);

    std::vector<JointMotion> motions;
    std::size_t there = 0;
    for (const auto& path : options.inputs) {
        std::size_t of_path = 0;
        for (auto& motion : reports::gather(path, wanted, &of_path)) motions.push_back(std::move(motion));
        there += of_path;
    }
    layout.size = options.size > 0                                           ? options.size
                  : kind != reports::PictureKind::png && motions.size() == 1 ? 480
                                                                             : 320;

    Progress progress("render", "frames");
    std::size_t frames = 0;
    reports::render(motions, layout, options.output, [&](std::size_t done, std::size_t all) {
        frames = all;
        progress.update(static_cast<double>(done) / static_cast<double>(all), done);
    });
    progress.clear();
    std::error_code of_a_stream;
    const auto size = fs::file_size(options.output, of_a_stream);
    const auto drawn = motions.size() < there ? fmt::format("{} of {} (--count, --per-class)", motions.size(),
                                                            counted(there, "motion"))
                                              : counted(motions.size(), "motion");
    say("{}: {}{}{}\n", options.output.string(), drawn, frames > 0 ? ", " + counted(frames, "frame") : "",
        of_a_stream ? "" : ", " + bytes(size));
}

/// Options that change nothing in the picture that is asked for.
void refuse_without_effect(const CLI::App& command, const RenderOptions& options) {
    if (reports::picture_kind(options.output) == reports::PictureKind::png)
        refuse_given(command, {"--fps"}, "is for a .gif or .mp4; a contact sheet does not move");
    else
        refuse_given(command, {"--columns"}, "is for a contact sheet (.png)");
    if (options.wanted.per_class > 0)
        refuse_given(command, {"--count"}, "--per-class says how many of every class");
    const auto& clips = options.wanted.clips;
    if (!clips.empty())
        refuse_given(command, {"--count", "--per-class", "--class", "--split"}, "--clip names the motions");
    for (auto clip = clips.begin(); clip != clips.end(); ++clip)
        if (std::find(clips.begin(), clip, *clip) != clip) throw Error("--clip: {} is given twice", *clip);
}

}  // namespace

void add_render(CLI::App& app) {
    auto* command = app.add_subcommand("render", "Draw motions: a contact sheet (.png), a .gif or an .mp4");
    auto options = std::make_shared<RenderOptions>();
    command
        ->add_option("INPUT", options->inputs,
                     "Datasets, motions files in the public layout (.h5), or raw .skeleton files")
        ->required();
    command
        ->add_option("-o,--out,--output", options->output,
                     "What to write: .png a contact sheet, .gif or .mp4 moving")
        ->required();
    command->add_option("--clip", options->wanted.clips, "Draw this clip; may be given again")
        ->allow_extra_args(false);
    command->add_option("--split", options->wanted.split, "Draw from this split of the dataset")
        ->capture_default_str();
    command->add_option("--class", options->wanted.label,
                        "Draw from this class: its name, or its number from 1");
    command->add_option("--count", options->wanted.count, "Motions of each INPUT, spread over its classes")
        ->check(CLI::Range(1, 400))
        ->capture_default_str();
    command
        ->add_option("--per-class", options->wanted.per_class,
                     "Motions of every class instead, a class a row of a .gif or .mp4")
        ->check(CLI::Range(1, 100));
    command->add_option(
        "--bones", options->wanted.bones,
        "Dataset whose skeleton and mean limb lengths a motions file is drawn with, before its own");
    command
        ->add_option("--body", options->body,
                     "SMPL's model file: draw its mean body, on rotations of SMPL's joints")
        ->type_name("FILE");
    command
        ->add_option("--view", options->view,
                     "Where it is seen from; or AZIMUTH,ELEVATION in degrees, as in 30,15")
        ->type_name(fmt::format("VIEW:{{{}}}", fmt::join(reports::view_names(), ",")))
        ->capture_default_str();
    command
        ->add_option("--size", options->size,
                     "Height of a motion's picture in pixels (default 320; 480 for one that moves)")
        ->check(CLI::Range(40, 4000));
    command->add_option("--columns", options->columns, "Snapshots in a row of the contact sheet")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command
        ->add_option("--fps", options->fps,
                     "Frames a second of a .gif or .mp4 (default: the motion's; a .gif has at most 50)")
        ->check(number_in(0.1, 1000));
    examples(command,
             "  actformer render data/ntu-1p -o sheet.png\n"
             "  actformer render raw/S001C001P001R001A001.skeleton -o raw.png\n"
             "  actformer render data/ntu-2p --class \"shaking hands\" --count 4 -o handshakes.gif\n"
             "  actformer render data/ntu-1p --clip S001C001P001R001A001 --view orbit -o drink.mp4\n"
             "  actformer render generated.h5 --per-class 4 -o generated.mp4\n"
             "  actformer render generated.h5 --body SMPL_NEUTRAL.pkl -o bodies.png\n");
    command->callback([options, command] {
        refuse_without_effect(*command, *options);
        render(*options);
    });
}

}  // namespace actformer::cli
