#include "ingest/formats/bvh/bvh_command.hpp"

#include "base/text/printable.hpp"
#include "ingest/formats/bvh/bvh_format.hpp"

namespace actformer::ingest {

std::vector<Option> BvhCommand::list() {
    return {
        Option(
            "--name",
            "What file names say: {action}, other {field}s, {*} for the rest; folders too: {action}/{index}",
            "PATTERN", &bvh.pattern),
        Option("--labels", "A table of files, actions, and more fields, as CSV with a header line; see below",
               "FILE", &bvh.labels),
        Option("--scale", "Metres a unit of the files, or auto: what makes the bodies as tall as people", "M",
               &bvh.scale)
            .with_default(),
        Option("--up", "The files' axis that points up", "AXIS", &bvh.up)
            .one_of({"y", "z", "-y", "-z", "x", "-x"})
            .with_default(),
        Option("--fps", "Resample to so many frames a second (default: as recorded)", "F", &bvh.fps),
        Option("--recorded-fps", "Frames a second of the recordings, where the files are wrong (.amc: 120)",
               "F", &bvh.recorded_fps),
        Option("--skip-first", "Leave out so many frames at the start of every file, as of reference poses",
               "N", &bvh.skip_first),
        Option("--start", "Leave out what comes before: frames, as in 30, or seconds, as in 1.5s", "T",
               &bvh.start),
        Option("--end", "Leave out what comes from there on", "T", &bvh.end),
        Option("--smooth", "Smooth with a Gaussian of so many frames (default: off)", "SIGMA", &bvh.smooth),
        Option("--positions",
               "Position channels below the root: replace the OFFSETs (default, where no limb vanishes by "
               "it), add to them, or are ignored",
               "HOW", &bvh.positions)
            .one_of({"replace", "add", "ignore"}),
        Option("--centre-windows",
               "Recogniser and generator see roots relative to their mean in a window, not in the clip: for "
               "long walks",
               "", &bvh.centre_windows),
        Option("--end-sites", "Keep end sites as joints called 'PARENT end'", "", &bvh.end_sites),
        Option("--root", "Joint to take as root, as in Hips (default: the one that carries the motion)",
               "JOINT", &bvh.root),
        Option(
            "--persons",
            "Persons a clip: ROOTs of a file, or files that differ in {person} (default: as in most clips)",
            "N", &bvh.persons),
        Option("--asf", "Skeleton of the .amc files that have none beside them", "FILE", &bvh.asf),
        Option("--classes", "Actions in the order of their labels (default: all that have a clip, sorted)",
               "A,B,...", &bvh.classes)
            .by_commas(),
        Option("--split", "A split by the clips' fields; may be given again", "NAME=FIELD:VALUE,...",
               &splits)};
}

std::unique_ptr<Format> BvhCommand::open(const std::string& dataset) const {
    auto options = bvh;
    options.dataset = dataset;
    for (auto& action : options.classes) action = printable(action);
    options.splits = parse_splits(splits);
    return std::make_unique<BvhFormat>(std::move(options));
}

}  // namespace actformer::ingest
