#include "ingest/formats/vibe/vibe.hpp"

#include <algorithm>

namespace actformer::ingest::vibe {

NumpyRows joint_rows(const NumpyArray& array, const std::string& name) {
    return NumpyRows(array, name, {joints, 3});
}

const Topology& action2motion18() {
    static const Topology topology{
        {"mid_hip", "neck", "right_shoulder", "right_elbow", "right_wrist", "left_shoulder", "left_elbow",
         "left_wrist", "nose", "right_hip", "right_knee", "right_ankle", "left_hip", "left_knee",
         "left_ankle", "left_heel", "right_heel", "head_top"},
        {-1, 0, 1, 2, 3, 1, 5, 6, 1, 0, 9, 10, 0, 12, 13, 14, 11, 8}};
    return topology;
}

std::vector<double> action2motion18_of(const NumpyRows& rows) {
    std::vector<double> out, row(rows.size());
    out.reserve(rows.count() * of_action2motion18.size() * 3);
    for (std::uint64_t t = 0; t < rows.count(); ++t) {
        rows.read(t, row.data());
        for (const auto joint : of_action2motion18)
            for (std::size_t d = 0; d < 3; ++d) out.push_back(row[3 * joint + d]);
    }
    return out;
}

}  // namespace actformer::ingest::vibe
