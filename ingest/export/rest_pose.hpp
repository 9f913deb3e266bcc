// Rest poses of well-known skeletons.
#pragma once

#include <vector>

#include "ingest/export/skeleton_motion.hpp"

namespace actformer::ingest {

/// (K) directions from the parent in a T pose, y up, the body facing +z with its left hand towards +x, as glTF wants it and as
/// SMPL's rest pose is. Known by their parents: NTU's 25 joints, SMPL's 24 and GTA Combat's 22. Empty for others.
std::vector<Point> t_pose(const Topology& topology);

}  // namespace actformer::ingest
