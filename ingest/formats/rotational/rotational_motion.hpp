// A body's rotations and translation over time, as AMASS, VIBE and AIST++ files tell them, in double precision.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "ingest/dataset/quaternion.hpp"
#include "ingest/smpl/smpl24.hpp"

namespace actformer::ingest {

/// One person, of SMPL's 24 joints.
struct RotationalMotion {
    std::uint32_t frames = 0;
    std::vector<Quaternion> rotations;  ///< (frames, 24) below the parent, the root's in the world
    std::vector<double> translation;    ///< (frames, 3) metres

    const Quaternion* pose(std::size_t frame) const { return &rotations[frame * smpl_joints]; }
};

/// What files hold: rotation vectors, frame by frame.
struct RotationVectors {
    std::uint64_t frames = 0;
    std::size_t joints =
        smpl_joints;  ///< that the file has, the first of SMPL's; those behind them do not turn

    /// Fills `vectors` (joints, 3), radians, and `translation` (3), metres, of a frame. Frames are asked for in rising order, a frame
    /// sometimes twice, and not all of them.
    std::function<void(std::uint64_t frame, double* vectors, double* translation)> read;
};

/// Every frame. Throws Error, naming the frame, for a number that is not finite, and for more than 2^20 frames.
RotationalMotion as_recorded(const RotationVectors& file);

/// Frame i shows time i/to, between the frames around it: rotations by slerp a joint, the translation linearly. The last frame is at
/// or before the recording's last. Both rates are frames a second. Throws Error as as_recorded does.
RotationalMotion resampled(const RotationVectors& file, double from, double to);

/// Turns the world: the root's rotation and the translation.
void turn(RotationalMotion& motion, const Quaternion& by);

/// What turns z up into y up: (x, y, z) becomes (x, z, -y).
inline constexpr Quaternion z_up_to_y_up{0.70710678118654752440, -0.70710678118654752440, 0, 0};

/// What turns y down, as cameras have it, into y up: half a turn about x.
inline constexpr Quaternion y_down_to_y_up{0, 1, 0, 0};

}  // namespace actformer::ingest
