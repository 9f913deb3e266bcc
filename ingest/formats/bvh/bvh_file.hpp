// The BVH format: a skeleton and the numbers that move it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ingest/formats/format.hpp"
#include "kernels/forward_kinematics.hpp"

namespace actformer::ingest {

struct BvhJoint {
    std::string name;  ///< printable; empty for an end site
    int parent = -1;   ///< -1 for the root
    bool end_site = false;
    std::array<double, 3> offset{};          ///< in the file's units, each below 1e9 either way
    std::vector<kernels::Channel> channels;  ///< at most 6
    std::uint32_t first_channel = 0;         ///< of all the file's channels
};

struct BvhFile {
    std::vector<BvhJoint> joints;  ///< as in the file: depth first, the root first, each after its parent
    std::uint32_t channels = 0;    ///< numbers a frame, at least 1
    std::uint32_t frames = 0;      ///< at least 1
    double frame_time = 0;         ///< seconds

    /// (channels, frames), in the file's units and in degrees of at most 360 either way. The root's position
    /// is relative to its first frame's, so that float32 holds a small motion far from the origin; only
    /// re-centred motion is wanted of it.
    std::vector<float> values;

    /// Frames a second: 1 / frame_time, or the whole number within 0.15 % of it, which 0.0333 and 0.0333333
    /// both stand for.
    double fps() const;

    /// The values of one channel, frame by frame.
    std::span<const float> channel(std::uint32_t c) const {
        return {&values[std::size_t{c} * frames], frames};
    }
};

/// Reads a whole file. 64 zero bytes follow `text`. Throws nothing for what is in the text.
/// Refused beside what is malformed: more than one ROOT, two joints of one name, more than 4096 joints.
std::variant<BvhFile, Rejection> parse_bvh(std::string_view text);

}  // namespace actformer::ingest
