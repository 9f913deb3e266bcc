// BABEL's annotations (Punnakkal et al. 2021): which actions a recording of AMASS shows, and when.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ingest/formats/format.hpp"

namespace actformer::ingest {

/// A label: some categories of action over a part of a sequence.
struct Segment {
    std::string id;                       ///< seg_id; empty: not told
    std::string text;                     ///< proc_label, or else raw_label
    std::vector<std::string> categories;  ///< act_cat, each once; empty where it is null
    std::optional<double> start, end;     ///< seconds; none: the sequence's own
};

struct Sequence {
    std::string id;                 ///< as the file calls it, as in "1234"
    std::string feat_p;             ///< path of its motion, as in CMU/CMU/01/01_01_poses.npz
    std::vector<Segment> segments;  ///< of frame_ann where there is one, else of seq_ann, in the file's order
};

struct Annotations {
    std::vector<Sequence> sequences;  ///< those that are sound, in the file's order
    std::vector<Rejection> faults;    ///< of the others: "sequence 12: ..."
    bool several_annotators = false;  ///< extra_train.json and extra_val.json: seq_anns and frame_anns
};

/// Throws nothing for what is in the text. A rejection is broken where it is no JSON, and dropped where it is JSON of something else.
std::variant<Annotations, Rejection> read_annotations(std::string_view text);

}  // namespace actformer::ingest
