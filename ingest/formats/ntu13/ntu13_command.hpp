// The options of `actformer ingest ntu13`.
#pragma once

#include "ingest/formats/format.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"

namespace actformer::ingest {

struct Ntu13Command : IngestCommand {
    RotationalOptions rotations;
    std::string from = "rotations";
    bool published = false;

    std::vector<Option> list() override;
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view ntu13_examples =
    "  actformer ingest ntu13 raw/ntu13 -o ntu13\n"
    "  actformer ingest ntu13 ntu13.zip -o ntu13-joints --from joints\n"
    "RAW holds ntu_vibe_list.txt and joblib files named as NTU's clips are, S001C001P001R001A099.pkl. The 13 "
    "classes are numbered as\n"
    "published; there is no split. Files of the list that are not there, and files in which person 1 was not "
    "tracked, are named in\n"
    "rejected.csv. Bodies are turned upright (the camera's y points down). With --from joints the dataset is "
    "of Action2Motion's 18\n"
    "joints, as limbs, or with --representation xyz as positions.\n";

}  // namespace actformer::ingest
