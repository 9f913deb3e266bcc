// The options of `actformer ingest humanact12`.
#pragma once

#include "ingest/formats/format.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"

namespace actformer::ingest {

struct HumanAct12Command : IngestCommand {
    RotationalOptions rotations;
    std::string from;
    double fps = 30;
    bool published = false;

    std::vector<Option> list() override;
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view humanact12_examples =
    "  actformer ingest humanact12 HumanAct12Poses.tar.gz -o humanact12\n"
    "  actformer ingest humanact12 HumanAct12.zip -o humanact12-joints\n"
    "  actformer ingest humanact12 humanact12poses.pkl -o humanact12-joints --from joints --representation "
    "xyz\n"
    "RAW holds humanact12poses.pkl (rotations and joints of all clips, as ACTOR has them) or "
    "P01G01R01F0001T0064A0101.npy and so on\n"
    "(joints, as Action2Motion has them). The 12 classes are those published; there is no split. Bodies are "
    "turned upright.\n";

}  // namespace actformer::ingest
