// A performer's body: bone lengths of the 25 Kinect joints.
#pragma once

#include <array>

#include "ingest/synth/geometry.hpp"

namespace actformer::ingest::synth {

/// The joints in the order of the files.
enum Joint : int {
    pelvis,
    spine,
    neck,
    head,
    left_shoulder,
    left_elbow,
    left_wrist,
    left_hand,
    right_shoulder,
    right_elbow,
    right_wrist,
    right_hand,
    left_hip,
    left_knee,
    left_ankle,
    left_foot,
    right_hip,
    right_knee,
    right_ankle,
    right_foot,
    chest,
    left_tip,
    left_thumb,
    right_tip,
    right_thumb,
    joints
};

using Joints = std::array<Vec, joints>;

/// Lengths in metres. Both sides are alike.
struct Body {
    double height = 1.72;
    double lower_spine = 0.28, upper_spine = 0.21, neck = 0.07, head = 0.14;
    double shoulder = 0.165, shoulder_drop = 0.02, upper_arm = 0.27, forearm = 0.245, hand = 0.075;
    double tip = 0.07, thumb = 0.05;
    double hip = 0.085, hip_drop = 0.03, thigh = 0.41, shin = 0.40, foot = 0.125, ankle = 0.085;
    double hip_ahead = 0;   ///< of the pelvis
    double hanging = 0.95;  ///< how far a hanging arm reaches, in its lengths
    double ball = 0.72;     ///< how far the ball of the foot is below the ankle, in ankle heights

    double scale() const { return height / 1.72; }
    double arm() const { return upper_arm + forearm + hand; }
    double leg() const { return thigh + shin; }
    double standing() const { return ankle + 0.985 * leg() + hip_drop; }  ///< height of the pelvis
};

/// The body of performer 1..106: the same whenever it is asked for.
Body body_of(int performer);

}  // namespace actformer::ingest::synth
