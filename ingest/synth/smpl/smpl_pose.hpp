// A performer's figure as rotations of SMPL's joints below the generic skeleton.
#pragma once

#include <array>

#include "ingest/smpl/smpl24.hpp"
#include "ingest/synth/performer/pose.hpp"

namespace actformer::ingest::synth {

struct SmplPose {
    Vec pelvis;                                ///< metres, on the stage
    std::array<Rotation, smpl_joints> turned;  ///< below the parent, the pelvis's on the stage
};

/// The body of the generic skeleton. Everybody has it in the stand-ins: readers without a body model draw all alike.
Body smpl_body();

/// Every bone points as the figure's does, whose body must be smpl_body(); feet and hips are where the figure's are. The spine has
/// other joints than the figure's: chest and arms may be some centimetres away.
SmplPose smpl_pose(const Figure& figure);

/// Sides exchanged: as if seen in a mirror that stands along the stage.
SmplPose mirrored(const SmplPose& pose);

/// Metres, on the stage, by forward kinematics of the generic skeleton.
std::array<Vec, smpl_joints> smpl_places(const SmplPose& pose);

}  // namespace actformer::ingest::synth
