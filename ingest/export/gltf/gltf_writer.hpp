// The glTF 2.0 format, written as one binary file (.glb).
#pragma once

#include <span>
#include <string>

#include "ingest/export/gltf/skin_figure.hpp"
#include "ingest/export/skeleton_motion.hpp"

namespace actformer::ingest {

/// The persons of one clip as one scene and one animation, both called `name`: metres, y up. A joint is a node with the rest
/// pose's translation; rotations of joints with children and positions of those that slide are keyed in every frame, linear in
/// between. Each person has a node above its root, since some programs make one skeleton of all that lie side by side, and is a skin over
/// `figure` or, where there is none, over a stick figure, since most viewers show no bare skeleton. With several persons nodes are
/// called "p1 pelvis", else "pelvis". The first frame is at 0 s. Throws Error for what exceeds the 4 GiB of the format.
std::string glb_bytes(std::span<const SkeletonMotion> persons, double fps, const std::string& name,
                      const SkinFigure* figure = nullptr);

}  // namespace actformer::ingest
