// Left and right of a skeleton.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ingest/dataset/topology.hpp"

namespace actformer::ingest {

/// For every joint the one on the body's other side, by their names: "left knee" and "right_knee", "LeftLeg" and "RightLeg", "Hand_L" and
/// "Hand_R". Joints without a side are their own. Throws Error, beginning with `where`, where no name tells a side, where a joint has no
/// counterpart, or where a joint's counterpart hangs on another joint than its parent's.
std::vector<std::uint32_t> other_side(const Topology& topology, const std::string& where);

}  // namespace actformer::ingest
