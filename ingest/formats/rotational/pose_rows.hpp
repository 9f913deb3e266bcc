// Rotation vectors of SMPL's joints in NumPy arrays of files.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "base/numpy/rows.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"

namespace actformer::ingest {

/// (frames, 72), which the file calls `name`. Throws Error where it has other joints, saying whose they are.
NumpyRows smpl_poses(const NumpyArray& array, std::string_view name);

/// Fills x, y, z, metres, of a frame.
using Translation = std::function<void(std::uint64_t frame, double* xyz)>;

/// All frames. Throws Error where there is none, and as as_recorded does.
RotationalMotion motion_of(const NumpyRows& poses, const Translation& translation);

/// A motion as one clip.
std::unique_ptr<RotationalClip> whole(const RotationalMotion& motion, const RotationalTarget& target);

}  // namespace actformer::ingest
