// The options of `actformer ingest ntu`.
#pragma once

#include "ingest/formats/format.hpp"

namespace actformer::ingest {

struct NtuCommand : IngestCommand {
    std::string missing;  ///< the list of clips with missing skeletons; empty: none
    std::string bodies = "frames";
    bool join_tracks = false;

    std::vector<Option> list() override;
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view ntu_examples =
    "  actformer ingest ntu nturgbd_skeletons_s001_to_s017.zip nturgbd_skeletons_s018_to_s032.zip \\\n"
    "      --missing NTU_RGBD120_samples_with_missing_skeletons.txt -o ntu\n"
    "  actformer ingest ntu raw/ -o ntu --strict\n"
    "  actformer ingest ntu raw/ -o ntu-mended --join-tracks --bodies motion\n"
    "A body or joint at 0 0 0 was not seen, and is filled from the frames around. Where the Kinect lost a "
    "person and numbered\n"
    "them anew, or a ghost was seen longer than the actor, the summary names the clips and the option that "
    "mends them.\n"
    "An interrupted run goes on where it was when the same command is given again.\n";

}  // namespace actformer::ingest
