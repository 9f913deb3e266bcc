// A skeleton and the numbers that move it, as BVH and ASF/AMC files hold them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/forward_kinematics.hpp"

namespace actformer::ingest {

struct RecordedJoint {
    std::string name;                ///< printable; empty for an end site and for a pivot
    int parent = -1;                 ///< -1 for the root
    bool end_site = false;           ///< the end of a last bone
    bool pivot = false;              ///< turns what hangs below it and is no joint of a dataset
    std::array<double, 3> offset{};  ///< place in the parent, in the file's units, each below 1e9 either way
    std::vector<kernels::Channel> channels;  ///< at most 6
    std::uint32_t first_channel = 0;         ///< of all the recording's channels
};

/// One person.
struct Recording {
    std::vector<RecordedJoint> joints;  ///< depth first, the root first, each after its parent
    std::uint32_t channels = 0;         ///< numbers a frame
    std::uint32_t frames = 0;           ///< at least 1
    double frame_time = 0;              ///< seconds

    /// (channels, frames), in the file's units and in degrees of at most 360 either way. The root's position is relative to
    /// `origin`, so that float32 holds a small motion far from the world's origin.
    std::vector<float> values;

    /// Where the root is in the first frame, in the file's units.
    std::array<double, 3> origin{};

    /// Frames a second: 1 / frame_time, or the whole number within 0.15 % of it, which 0.0333 and 0.0333333
    /// both stand for.
    double fps() const;

    /// The values of one channel, frame by frame.
    std::span<const float> channel(std::uint32_t c) const {
        return {&values[std::size_t{c} * frames], frames};
    }
};

/// True for the channels that move a joint, false for those that turn it.
constexpr bool is_position(kernels::Channel channel) {
    return channel < kernels::Channel::x_rotation;
}

/// 0, 1 or 2: the axis along or about which a channel works.
constexpr std::size_t axis_of(kernels::Channel channel) {
    return static_cast<std::size_t>(channel) % 3;
}

}  // namespace actformer::ingest
