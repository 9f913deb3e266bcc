// Motions of any known skeleton as a recogniser of the 15 common joints sees them.
#pragma once

#include "eval/scoring/motion_source.hpp"
#include "ingest/dataset/common_joints.hpp"

namespace actformer::eval {

/// True where the recogniser's tree is that of common15(), and the motions have another.
bool sees_common_joints(const std::vector<int>& recogniser, const MotionsInfo& motions);

/// What is known of the motions once they are seen so. Throws Error where they cannot be: see ingest::CommonJoints.
MotionsInfo in_common_joints(const MotionsInfo& motions);

/// The batch's values as limbs of common15(), (rows, persons * 3, frames, 15). Its values lie in host memory.
std::vector<float> in_common_joints(const MotionBatch& batch, const MotionsInfo& motions);

}  // namespace actformer::eval
