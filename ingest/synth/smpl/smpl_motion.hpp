// Performances as SMPL's rotations: played, put in their place, joined and resampled.
#pragma once

#include <cstdint>
#include <vector>

#include "ingest/synth/performer/play.hpp"
#include "ingest/synth/smpl/life.hpp"
#include "ingest/synth/smpl/smpl_pose.hpp"

namespace actformer::ingest::synth {

constexpr double play_fps = 30;

/// A pose a frame at play_fps. On the stage y is up and the floor is y = 0; people begin near its middle and face +z.
using SmplMotion = std::vector<SmplPose>;

struct SmplPlay {
    std::vector<SmplMotion> persons;
    int contact = -1;  ///< the frame at which two persons touch, if they do
};

/// `key` makes the performance the one it is, `performers` tells habits, a number a person. All have smpl_body().
SmplPlay smpl_play(const Programme& programme, const std::vector<std::uint64_t>& key,
                   const std::vector<std::uint64_t>& performers, const Life& life);

/// The motion of a programme's only person.
SmplMotion smpl_solo(const Programme& programme, const std::vector<std::uint64_t>& key,
                     std::uint64_t performer, const Life& life);

/// Turned about y by `heading` degrees, and then moved by `way`.
void place(SmplMotion& motion, double heading, const Vec& way);

/// Turned by `heading`, and moved so that its middle is `aside` of what a camera at the origin looks at, 1 m below it, and nobody comes
/// nearer to it than `distance`.
void place_before_camera(SmplMotion& motion, double heading, double aside, double distance);

/// Which way the pelvis faces, degrees about y from z.
double heading_of(const SmplPose& pose);

/// Appends `next` where `motion` ends, with `between` frames from one pose to the other. What comes before is left as it is.
void go_on(SmplMotion& motion, SmplMotion next, std::size_t between);

/// At frame `i` what the motion shows at time i / fps; all joints at constant speed between its frames.
SmplMotion resampled(const SmplMotion& motion, double fps);

/// Seen from other axes: the pelvis turned and moved by `axes`.
SmplMotion in_axes(const SmplMotion& motion, const Rotation& axes);

/// Rotation vectors of the joints, (24, 3) radians.
std::vector<double> rotation_vectors(const SmplPose& pose);

/// Axes of a camera that looks along z, x to the right and y down, from those of a stage before it, whose z points at it.
inline constexpr Rotation below_camera{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};

/// Axes whose z is up, from those of the stage.
inline constexpr Rotation z_up{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};

}  // namespace actformer::ingest::synth
