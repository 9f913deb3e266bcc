// A body for a skeleton that has none: an eight-sided bone from each joint to each of its children.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ingest/export/skeleton_motion.hpp"

namespace actformer::ingest {

/// Triangles, three corners each, counter-clockwise from outside. Every corner follows one joint.
struct StickFigure {
    std::vector<float> positions;       ///< (corners, 3) metres in the rest pose, the root at the origin
    std::vector<float> normals;         ///< (corners, 3) of length 1
    std::vector<std::uint16_t> joints;  ///< (corners)

    std::size_t corners() const { return joints.size(); }
};

/// Bones begin at the joint and end at the child, whose tips follow the child. A skeleton without bones of any length gets one that stands on its root.
StickFigure stick_figure(const SkeletonMotion& motion);

/// (K) places of the joints in the rest pose, in metres, the root at the origin.
std::vector<Point> rest_places(const SkeletonMotion& motion);

}  // namespace actformer::ingest
