// The Kinect numbers the bodies it tracks. When it loses a person and finds them again, they get a new number: one person, two tracks.
#pragma once

#include <vector>

#include "ingest/formats/ntu/skeleton_file.hpp"

namespace actformer::ingest {

/// How tracks follow one another: the later begins at most this many frames after the earlier ended (one second), ...
constexpr std::uint32_t longest_gap = 30;
/// ... with its root at most this far away, and this much farther for each frame between, in metres. A person walks 0.05 m a frame.
constexpr double farthest_apart = 0.3, farther_a_frame = 0.05;

/// Tracks of one person, as indices into `tracks` in the order of time; the persons in the order in which they first appear. Tracks
/// seen in the same frame are different persons. Where several may follow one another the nearest do.
std::vector<std::vector<std::size_t>> persons_of(const std::vector<Body>& tracks);

/// One body a person.
std::vector<Body> joined(const std::vector<Body>& tracks,
                         const std::vector<std::vector<std::size_t>>& persons);

}  // namespace actformer::ingest
