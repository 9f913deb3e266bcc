// A performer's figure as rotations of SMPL's joints below the generic skeleton.
#pragma once

#include <array>

#include "ingest/smpl/smpl24.hpp"
#include "ingest/synth/performer/pose.hpp"

namespace actformer::ingest::synth {

enum SmplJoint : std::size_t {
    pelvis24,
    left_hip24,
    right_hip24,
    spine1,
    left_knee24,
    right_knee24,
    spine2,
    left_ankle24,
    right_ankle24,
    spine3,
    left_foot24,
    right_foot24,
    neck24,
    left_collar,
    right_collar,
    head24,
    left_shoulder24,
    right_shoulder24,
    left_elbow24,
    right_elbow24,
    left_wrist24,
    right_wrist24,
    left_hand24,
    right_hand24
};

using SmplTurns = std::array<Rotation, smpl_joints>;

struct SmplPose {
    Vec pelvis;        ///< metres, on the stage
    SmplTurns turned;  ///< below the parent, the pelvis's on the stage
};

/// Where joints are, and how they are turned on the stage.
struct SmplPlaced {
    std::array<Vec, smpl_joints> at;  ///< metres
    SmplTurns world;
};

/// Of the generic skeleton: from the parent, metres. Thighs and shins point along -y, arms along x.
const std::array<Vec, smpl_joints>& smpl_offsets();

/// The body of the generic skeleton. Everybody has it in the stand-ins: readers without a body model draw all alike.
Body smpl_body();

/// Every bone points as the figure's does, whose body must be smpl_body(); feet and hips are where the figure's are. The spine has
/// other joints than the figure's: chest and arms may be some centimetres away. Toes bend when the heel rises, hands when they grip.
SmplPose smpl_pose(const Figure& figure);

/// From rotations on the stage, and the pelvis's place there.
SmplPose smpl_pose(const Vec& at, const SmplTurns& world);

/// Sides exchanged: as if seen in a mirror that stands along the stage.
SmplPose mirrored(const SmplPose& pose);

/// By forward kinematics of the generic skeleton.
SmplPlaced smpl_placed(const SmplPose& pose);

/// Their places alone, metres, on the stage.
std::array<Vec, smpl_joints> smpl_places(const SmplPose& pose);

}  // namespace actformer::ingest::synth
