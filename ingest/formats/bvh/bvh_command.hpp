// The options of `actformer ingest bvh`.
#pragma once

#include "ingest/formats/bvh/bvh_format.hpp"

namespace actformer::ingest {

struct BvhCommand : IngestCommand {
    BvhOptions bvh;
    std::vector<std::string> splits;  ///< as parse_split takes them

    std::vector<Option> list() override;
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view bvh_examples =
    "  actformer ingest bvh walks/ -o walks --name '{action}_{index}'\n"
    "  actformer ingest bvh bnr2.tar.xz -o bnr-10 --name 'dataset-2_{action}_{style}_{index}' \\\n"
    "      --split 'xstyle/train=style:active,exhausted,masculine,normal' \\\n"
    "      --split 'xstyle/test=style:elderly,feminine,youthful'\n"
    "  actformer ingest bvh captures.zip -o captures --name '{*}_{action}_{*}' --fps 30 --scale 1\n"
    "The joints come from the first sound file; files with other joints are left out and named.\n"
    "Position channels take the place of offsets. An interrupted run goes on when given again.\n";

}  // namespace actformer::ingest
