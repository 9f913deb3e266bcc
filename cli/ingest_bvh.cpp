// actformer ingest bvh: any folder or archive of BVH files of one skeleton to one dataset.
#include <filesystem>

#include "cli/ingest.hpp"
#include "ingest/formats/bvh/bvh_format.hpp"

namespace actformer::cli {
namespace {

struct Options : IngestOptions {
    ingest::BvhOptions bvh;
    std::vector<std::string> splits;
};

/// The last part of DIR names the dataset.
std::string dataset_name(const std::string& out) {
    auto path = std::filesystem::absolute(out).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    return path.filename().string();
}

void run_bvh(Options& options) {
    options.bvh.dataset = dataset_name(options.out);
    for (const auto& split : options.splits) options.bvh.splits.push_back(ingest::parse_split(split));
    const auto format = ingest::open_bvh(options.bvh, {options.raw.begin(), options.raw.end()});
    run_ingest(options, *format, true);
}

void add_bvh_options(CLI::App* command, Options& options) {
    auto& bvh = options.bvh;
    command
        ->add_option("--name", bvh.pattern, "What file names say: {action}, other {field}s, {*} for the rest")
        ->required()
        ->type_name("PATTERN");
    command->add_option("--scale", bvh.scale, "Metres a unit of the files")
        ->capture_default_str()
        ->type_name("M");
    command->add_option("--fps", bvh.fps, "Resample to so many frames a second (default: as recorded)")
        ->type_name("F");
    command->add_option("--smooth", bvh.smooth, "Smooth with a Gaussian of so many frames (default: off)")
        ->type_name("SIGMA");
    command->add_flag("--centre-windows", bvh.centre_windows,
                      "Recogniser and generator see roots relative to their mean in a window, not in the "
                      "clip: for long walks");
    command->add_flag("--end-sites", bvh.end_sites, "Keep end sites as joints called 'PARENT end'");
    command
        ->add_option("--root", bvh.root,
                     "Joint to take as root, as in Hips (default: the first that moves about)")
        ->type_name("JOINT");
    command
        ->add_option("--classes", bvh.classes, "Actions in the order of their labels (default: all, sorted)")
        ->delimiter(',')
        ->allow_extra_args(false)  // or it would take the RAW that may follow
        ->type_name("A,B,...");
    command->add_option("--split", options.splits, "A split by the names' fields; may be given again")
        ->allow_extra_args(false)
        ->type_name("NAME=FIELD:VALUE,...");
}

}  // namespace

void add_ingest_bvh(CLI::App& ingest) {
    auto options = std::make_shared<Options>();
    auto* command = ingest.add_subcommand("bvh", "BVH files of one skeleton -> the dataset DIR");
    add_ingest_options(command, *options);
    add_bvh_options(command, *options);
    examples(command,
             "  actformer ingest bvh walks/ -o walks --name '{action}_{index}'\n"
             "  actformer ingest bvh bnr2.tar.xz -o bnr-10 --name 'dataset-2_{action}_{style}_{index}' \\\n"
             "      --split 'xstyle/train=style:active,exhausted,masculine,normal' \\\n"
             "      --split 'xstyle/test=style:elderly,feminine,youthful'\n"
             "  actformer ingest bvh captures.zip -o captures --name '{*}_{action}_{*}' --fps 30 --scale 1\n"
             "The joints come from the first sound file; files with other joints are left out and named.\n"
             "Position channels take the place of offsets. An interrupted run goes on when given again.\n");
    command->callback([options] { run_bvh(*options); });
}

}  // namespace actformer::cli
