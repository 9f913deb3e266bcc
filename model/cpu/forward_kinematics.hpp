// Joints of a rest skeleton, turned by rotations: where they are, and how far two motions' joints lie apart. T float or double.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace actformer::model::cpu {

constexpr std::int64_t rotation_numbers = 6;  ///< two rows of a rotation

struct RestSkeleton {
    std::vector<int> order;    ///< joints, each behind its parent; the root first
    std::vector<int> parents;  ///< (joints); -1 for the root
    std::vector<std::array<float, 3>>
        offsets;  ///< (joints) from the parent, unturned; the root's is not used
};

/// Of motions (samples, persons * 6, frames, joints + 1): the first two rows of each joint's rotation below its parent, of any length;
/// the last node, the translation, is not looked at.
struct RotationsShape {
    std::int64_t samples, persons, frames;
};

/// Positions of the joints from the root, `to` (samples, persons * 3, frames, joints).
template <typename T>
void forward_kinematics(const RestSkeleton& skeleton, const RotationsShape& shape, const T* rotations, T* to,
                        int threads);

/// From gradients to those positions, the gradients to the rotations, `to` (samples, persons * 6, frames, joints + 1).
template <typename T>
void forward_kinematics_backward(const RestSkeleton& skeleton, const RotationsShape& shape,
                                 const T* rotations, const T* to_positions, T* to, int threads);

/// The sum of squared differences between the positions, from the root, of both motions' joints. `to` gets its gradient to `made`.
template <typename T>
double joint_differences(const RestSkeleton& skeleton, const RotationsShape& shape, const T* made,
                         const T* real, T* to, int threads);

}  // namespace actformer::model::cpu
