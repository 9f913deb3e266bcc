// Forward kinematics on the device: from joint angles, as BVH files hold them, to limbs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/buffer.hpp"

namespace actformer::kernels {

/// What a number of a frame moves. Rotations are in degrees, right-handed.
enum class Channel : std::uint8_t { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };

struct KinematicJoint {
    std::int32_t parent = -1;       ///< -1 for the root
    std::array<float, 3> offset{};  ///< place in the parent, in units of the recording
    std::vector<Channel> channels;  ///< at most 6, in any order; they follow those of the joint before
    bool kept = true;               ///< shows in the limbs
};

/// One clip. The joints run depth first, each after its parent, the root first.
struct KinematicClip {
    std::span<const KinematicJoint> joints;
    std::uint32_t frames = 0;       ///< at least 1
    std::span<const float> values;  ///< (channels, frames)
};

/// Limbs (total frames, K, 3) in metres, for K kept joints a clip in the joints' order: joint 0 the position
/// of the first kept joint, joint k the vector from k's nearest kept ancestor to k. What is not kept moves
/// its children all the same.
///
/// A position channel takes the place of its coordinate of the OFFSET, as in the files of most motion capture
/// software, which repeat the offset in the channel. For the hierarchy's root some readers add the two
/// instead: this moves the whole clip by a constant, which re-centring (normalise) takes away. Rotations
/// apply in the order of the channels: channels a b c mean the matrix A B C.
///
/// The result is a limb_buffer, as cleaning takes it. Throws Error where the clips' kept joints differ in number, or a clip is not as described.
Buffer<float> forward_kinematics(Device& device, std::span<const KinematicClip> clips, float metres_per_unit);

}  // namespace actformer::kernels
