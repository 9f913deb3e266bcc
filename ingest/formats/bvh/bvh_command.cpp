#include "ingest/formats/bvh/bvh_command.hpp"

namespace actformer::ingest {

std::vector<Option> BvhCommand::list() {
    return {
        Option("--name", "What file names say: {action}, other {field}s, {*} for the rest", "PATTERN",
               &bvh.pattern)
            .required(),
        Option("--scale", "Metres a unit of the files", "M", &bvh.scale).with_default(),
        Option("--fps", "Resample to so many frames a second (default: as recorded)", "F", &bvh.fps),
        Option("--smooth", "Smooth with a Gaussian of so many frames (default: off)", "SIGMA", &bvh.smooth),
        Option("--centre-windows",
               "Recogniser and generator see roots relative to their mean in a window, not in the clip: for "
               "long "
               "walks",
               "", &bvh.centre_windows),
        Option("--end-sites", "Keep end sites as joints called 'PARENT end'", "", &bvh.end_sites),
        Option("--root", "Joint to take as root, as in Hips (default: the first that moves about)", "JOINT",
               &bvh.root),
        Option("--classes", "Actions in the order of their labels (default: all, sorted)", "A,B,...",
               &bvh.classes)
            .by_commas(),
        Option("--split", "A split by the names' fields; may be given again", "NAME=FIELD:VALUE,...",
               &splits)};
}

std::unique_ptr<Format> BvhCommand::open(const std::string& dataset) const {
    auto options = bvh;
    options.dataset = dataset;
    for (const auto& split : splits) options.splits.push_back(parse_split(split));
    return std::make_unique<BvhFormat>(std::move(options));
}

}  // namespace actformer::ingest
