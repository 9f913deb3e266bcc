// The options of `actformer ingest nturecon`.
#pragma once

#include "ingest/formats/format.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"

namespace actformer::ingest {

struct NtuReconCommand : IngestCommand {
    RotationalOptions rotations;

    std::vector<Option> list() override { return rotations.list(); }
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view nturecon_examples =
    "  actformer ingest nturecon motions/ -o nturecon\n"
    "  actformer ingest nturecon motions.tar.gz -o nturecon-limbs --representation limb\n"
    "RAW holds S001C001P001R001A001_body0.pkl and so on with the keys smpl_poses, smpl_trans and "
    "smpl_scaling, as AIST++'s fitting\n"
    "writes them. The 94 actions of one person are the classes; xsub/train and xsub/test split by "
    "performers. Files of body1 on and\n"
    "of actions of two persons are left out and named in rejected.csv. Bodies are turned upright, "
    "translations are in metres.\n";

}  // namespace actformer::ingest
