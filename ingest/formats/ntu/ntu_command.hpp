// The options of `actformer ingest ntu`.
#pragma once

#include "ingest/formats/format.hpp"

namespace actformer::ingest {

struct NtuCommand : IngestCommand {
    std::string missing;  ///< the list of clips with missing skeletons; empty: none

    std::vector<Option> list() override;
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view ntu_examples =
    "  actformer ingest ntu nturgbd_skeletons_s001_to_s017.zip nturgbd_skeletons_s018_to_s032.zip \\\n"
    "      --missing NTU_RGBD120_samples_with_missing_skeletons.txt -o ntu\n"
    "  actformer ingest ntu raw/ -o ntu --strict\n"
    "An interrupted run goes on where it was when the same command is given again.\n";

}  // namespace actformer::ingest
