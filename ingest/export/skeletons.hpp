// The joints and the moving skeletons of a clip in any representation.
#pragma once

#include "ingest/export/clip_source.hpp"
#include "ingest/export/skeleton_motion.hpp"

namespace actformer::ingest {

/// (frames, persons, K) in metres. Limbs point the way and the bone lengths give the lengths: what the 1e-4 of their
/// normalisation took from a limb is not missed here.
std::vector<Point> clip_joints(const ExportClip& clip);

/// (K) directions from the parent to take as the rest pose of all clips of an export of which this is the first: a T pose where
/// the skeleton is a known one, else that of the clip's first person in its first frame.
std::vector<Point> rest_pose(const ExportClip& first);

/// One a person. Rotations are taken as they are, on their rest skeleton. Limbs and positions give joints, and these
/// minimal_twist on `pose`. Throws Error naming the clip where a rotation is none.
std::vector<SkeletonMotion> skeletons_of(const ExportClip& clip, const std::vector<Point>& pose);

}  // namespace actformer::ingest
