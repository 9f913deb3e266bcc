// Small turns of every joint: nobody's knee is a hinge, and no estimate of a pose is without error. Feet, hands, chest and the way
// the face looks stay where the performance has them: feet stand, blows meet.
#pragma once

#include <vector>

#include "ingest/synth/random.hpp"
#include "ingest/synth/smpl/smpl_pose.hpp"

namespace actformer::ingest::synth {

/// Deviations about each axis of a joint, degrees.
struct Life {
    double habit = 0;  ///< the same throughout a clip
    double sway = 0;   ///< smooth, at 0.3 to 2 Hz
};

inline constexpr Life of_mocap{2.2, 1.4};
inline constexpr Life of_video{3.5, 2};  ///< poses estimated from images, as VIBE's

/// `motion` has 30 frames a second, on the stage.
void enliven(std::vector<SmplPose>& motion, const Life& life, Random random);

}  // namespace actformer::ingest::synth
