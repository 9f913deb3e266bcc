// Resampling as the public tools of ActFormer do it: scipy.ndimage.zoom along time, through the rotation vectors' own numbers.
//
// A cubic spline through the samples, whose first and last frame become the new first and last, so that the rate is not quite the one
// asked for. Vectors that flip from pi to -pi overshoot in between. Where rounding puts the last place a hair behind the last frame,
// SciPy makes that frame 0; here it is the last frame. For comparison with published figures alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ingest/formats/rotational/rotational_motion.hpp"

namespace actformer::ingest {

/// round(frames * to / from), half to even as Python rounds; 0 for a recording too short.
std::uint64_t zoomed_frames(std::uint64_t frames, double from, double to);

/// `values` (frames, columns) at `wanted` frames, evenly from the first to the last: the interpolating cubic B-spline whose samples are
/// mirrored at both ends (Unser 1999).
std::vector<double> zoomed(std::span<const double> values, std::uint64_t frames, std::uint64_t wanted);

/// A recording at about `to` frames a second in place of `from`: rotation vectors and translation. Throws Error as as_recorded does.
RotationalMotion zoomed(const RotationVectors& file, double from, double to);

}  // namespace actformer::ingest
