// The options of `actformer ingest bvh`.
#pragma once

#include "ingest/formats/bvh/bvh_options.hpp"
#include "ingest/formats/format.hpp"

namespace actformer::ingest {

struct BvhCommand : IngestCommand {
    BvhOptions bvh;
    std::vector<std::string> splits;  ///< as parse_splits takes them

    std::vector<Option> list() override;
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view bvh_examples =
    "  actformer ingest bvh raw/walks -o walks --name '{action}_{index}'\n"
    "  actformer ingest bvh raw/captures -o captures --name '{action}/{index}' --up z --scale auto --fps 30\n"
    "  actformer ingest bvh bnr2.tar.xz -o bnr-10 --name 'dataset-2_{action}_{style}_{index}' \\\n"
    "      --split 'xstyle/train=style:active,exhausted,masculine,normal' \\\n"
    "      --split 'xstyle/test=style:elderly,feminine,youthful'\n"
    "  actformer ingest bvh raw/pairs -o pairs --name '{action}_{take}_{person}' --skip-first 1\n"
    "  actformer ingest bvh raw/cmu -o cmu --labels labels.csv --scale auto --split 'test=split:test'\n"
    "A table of labels has a line a clip below its header: file,action,start_frame,end_frame,FIELD,... "
    "where\n"
    "frames may be left out, and several lines cut a file into clips. CMU's .amc files are read with the "
    ".asf\n"
    "skeletons beside them. The skeleton is the one that most files have, joints matched by name; other "
    "files\n"
    "are left out and named. An interrupted run goes on when given again.\n";

}  // namespace actformer::ingest
