// The raw text of one NTU RGB+D clip (DESIGN 4.1).
#pragma once

#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "ingest/formats/format.hpp"

namespace actformer::ingest {

constexpr std::size_t ntu_joints = 25;

/// What a file shows of one body: detections[i] in frame times[i], frames rising.
struct Body {
    std::string_view id;               ///< as the file spells it; lives as long as the text
    std::vector<std::uint32_t> times;  ///< frames
    std::vector<float> limbs;  ///< (detections, 25, 3) metres: child - parent; joint 0 relative to an origin
                               ///< that all bodies of the clip share
};

struct SkeletonFile {
    std::uint32_t frames = 0;
    std::vector<Body> bodies;  ///< in order of first appearance
};

/// `text` must have 64 zero bytes behind it. Rejects with the line and what is wrong with it. A body listed twice in a
/// frame counts once: the later wins.
std::variant<SkeletonFile, Rejection> read_skeleton(std::string_view text);

}  // namespace actformer::ingest
