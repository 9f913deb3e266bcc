// A body for a skeleton that has none: an eight-sided bone from each joint to each of its children.
#pragma once

#include "ingest/export/gltf/skin_figure.hpp"
#include "ingest/export/skeleton_motion.hpp"

namespace actformer::ingest {

/// Triangles of three corners each, which follow one joint. Bones begin at the joint and end at the child, whose tips follow the child. A skeleton without bones of any length gets one that stands on its root.
SkinFigure stick_figure(const SkeletonMotion& motion);

/// (K) places of the joints in the rest pose, in metres, the root at the origin.
std::vector<Point> rest_places(const SkeletonMotion& motion);

}  // namespace actformer::ingest
