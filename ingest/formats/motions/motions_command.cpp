#include "ingest/formats/motions/motions_command.hpp"

namespace actformer::ingest {

std::vector<Option> MotionsCommand::list() {
    return {
        Option("--topology",
               "Joints and parents: ntu25, smpl24, coco17, h36m17, gta22, common15 or a YAML or JSON file",
               "NAME|FILE", &motions.topology),
        Option("--labels", "A table of the clips' labels, and of fields for --split", "FILE.csv",
               &motions.labels),
        Option("--name", "What names and folders say: {action}, other {field}s, {*} for the rest", "PATTERN",
               &motions.pattern),
        Option("--split", "A split by the fields; may be given again", "NAME=FIELD:VALUE,...", &splits),
        Option("--axes",
               "Order of the arrays' axes: n clips, t frames, p persons, k joints, c coordinates, as in "
               "nctkp (default: by "
               "their lengths)",
               "LETTERS", &motions.axes),
        Option("--persons",
               "Persons of a clip, those seen most; clips with fewer are left out (default: as most have)",
               "P", &motions.persons),
        Option("--fps", "Frames a second of the recordings (default: as the files say, or 30)", "F",
               &motions.fps),
        Option("--scale", "Metres a unit of the positions", "M", &motions.scale).with_default(),
        Option("--up", "Axis of the positions that points up", "AXIS", &motions.up)
            .one_of({"y", "z", "x", "-y", "-z", "-x"})
            .with_default(),
        Option("--representation", "What positions become: limb (default) or xyz, which keeps them", "REP",
               &motions.representation)
            .one_of({"limb", "xyz"}),
        Option("--clean", "Smooth positions as NTU's are, with a Gaussian of 3 frames", "", &motions.clean),
        Option("--centre-windows",
               "Recogniser and generator see roots relative to their mean in a window, not in the clip: for "
               "long walks",
               "", &motions.centre_windows)};
}

std::unique_ptr<Format> MotionsCommand::open(const std::string& dataset) const {
    auto options = motions;
    options.dataset = dataset;
    options.splits = parse_splits(splits);
    return std::make_unique<MotionsFormat>(std::move(options));
}

}  // namespace actformer::ingest
