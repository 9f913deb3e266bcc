// Normals of a mesh of triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace actformer::ingest {

/// (V, 3) of length 1 for vertices (V, 3): each the mean of its faces' normals weighted by their areas, faces being counter-clockwise
/// from outside; up where a vertex has no face.
std::vector<float> vertex_normals(std::span<const float> vertices, std::span<const std::uint32_t> faces);

}  // namespace actformer::ingest
