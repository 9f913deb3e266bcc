// The options of `actformer ingest uestc`.
#pragma once

#include "ingest/formats/format.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"

namespace actformer::ingest {

struct UestcCommand : IngestCommand {
    RotationalOptions rotations;
    bool published = false;

    std::vector<Option> list() override;
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view uestc_examples =
    "  actformer ingest uestc uestc.tar.bz2 -o uestc\n"
    "  actformer ingest uestc uestc/ -o uestc-xyz --representation xyz\n"
    "RAW holds vibe_cache_refined.pkl and info/ with names.txt, num_frames_min.txt and action_classes.txt. "
    "Videos of the side cameras\n"
    "are turned to face the camera in front; those whose camera moves are left out. The trajectory comes "
    "from\n"
    "VIBE's cameras. train (51 subjects) and test are the published split. The pickle may be larger than "
    "memory; out of an archive\n"
    "it is unpacked into the folder that TMPDIR names.\n";

}  // namespace actformer::ingest
