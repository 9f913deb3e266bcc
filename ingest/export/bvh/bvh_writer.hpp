// The BVH format, written.
#pragma once

#include <string>

#include "ingest/export/skeleton_motion.hpp"

namespace actformer::ingest {

/// One person as a BVH file. Offsets and positions are in centimetres, as most programs take them, angles in degrees; six decimals
/// of both. Joints follow depth first. Channels are Zrotation Xrotation Yrotation, R = Z X Y, for every joint, the three
/// positions before them for the root and for joints that slide: these take the place of the joint's OFFSET. Angles run on
/// across 180 degrees where the joint does. Every leaf has an end site of no length. `motion.topology.names` must be fit for BVH.
std::string bvh_text(const SkeletonMotion& motion, double fps);

/// Rotations about z, x and y in degrees with Z X Y = the rotation; of the two such triples, and whole turns more or less, that
/// nearest to `before`.
Point zxy_degrees(const Quaternion& rotation, const Point& before);

}  // namespace actformer::ingest
