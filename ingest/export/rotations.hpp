// Joint positions to the rotations of a skeleton. Positions leave the twist about each bone open: it is taken as small as can be.
#pragma once

#include <span>

#include "ingest/export/skeleton_motion.hpp"

namespace actformer::ingest {

/// Further than this from its place in the rest pose, in metres, a joint slides.
constexpr double rigid_within = 1e-6;

/// The rotations that bring a skeleton to `joints` (frames, K), in metres.
///
/// A joint with one child turns by the smallest rotation, seen from its parent, that points the bone the right way. A joint with
/// several takes the rotation that suits the directions of all of them best in the least-squares sense (Kabsch 1976), and where
/// these lie on one line, the smallest of those. A joint without children does not turn. What no rotation can reproduce, as where
/// the angle between two hips varies or a bone's length does, becomes a moving position: joints come out exactly all the same.
///
/// `pose` (K) is the rest pose as directions from the parent, of any length; (0, 0, 0) where it is not known. Bones get
/// their mean length over the frames. Among the children of one joint the angles become the mean ones: bones that keep them come
/// out as pure rotations whatever the pose.
SkeletonMotion minimal_twist(const Topology& topology, std::span<const Point> joints,
                             std::span<const Point> pose);

}  // namespace actformer::ingest
