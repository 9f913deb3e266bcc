// The raw text of one NTU RGB+D clip: the number of frames; in each frame the number of bodies; for each body a line of 10
// fields, the number of joints, and a line of 12 fields a joint, of which the first three are its position in metres.
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
    std::vector<Body> bodies;             ///< in order of first appearance
    bool filled = false;                  ///< some bodies or joints were listed at 0 0 0
    std::vector<std::size_t> never_seen;  ///< a joint of each body that is left out for it
};

/// `text` must have 64 zero bytes behind it. Rejects with the line and what is wrong with it. A body listed twice in a
/// frame counts once: the later wins.
///
/// A position of 0 0 0, the camera itself, or with a NaN is none. A body without any joint was not seen in that frame. A single
/// joint is put where the frames around say: linearly between its positions before and after, held at the ends. A body with a
/// joint that is never seen is left out.
std::variant<SkeletonFile, Rejection> read_skeleton(std::string_view text);

}  // namespace actformer::ingest
