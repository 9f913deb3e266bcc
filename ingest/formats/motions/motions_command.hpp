// The options of `actformer ingest motions`.
#pragma once

#include "ingest/formats/motions/motions_format.hpp"

namespace actformer::ingest {

struct MotionsCommand : IngestCommand {
    MotionsOptions motions;
    std::vector<std::string> splits;  ///< as parse_splits takes them

    std::vector<Option> list() override;
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view motions_examples =
    "  actformer ingest motions joints.npy -o mine --topology smpl24 --labels labels.csv --fps 30\n"
    "  actformer ingest motions raw/takes -o takes --topology skeleton.yaml --name '{action}/{index}' --up z "
    "--scale 0.001\n"
    "  actformer ingest motions kinect.npy -o kinect --topology ntu25 --axes nctkp --clean --labels "
    "labels.csv\n"
    "  actformer export ntu/ntu-1p -o ntu.h5 && actformer ingest motions ntu.h5 -o again\n"
    "Arrays hold (frames, joints, 3), (frames, persons, joints, 3), (clips, frames, joints, 3) or (clips, "
    "frames,\n"
    "persons, joints, 3) numbers; NaN, and a body of zeros, is not seen. A .csv file has a line a joint "
    "(frame, person,\n"
    "joint, x, y, z) or a line a frame. Without --name and --labels, classes are what the files tell: A001 "
    "is class 1.\n"
    "A table of labels has a line a clip: name,label,FIELD,... where clip 7 of joints.npy is called "
    "joints_7.\n"
    "A topology file says names: [hips, knee, ...], parents: [-1, 0, ...]; what export wrote needs none.\n";

}  // namespace actformer::ingest
