// What a glTF skin bends.
#pragma once

#include <cstdint>
#include <vector>

namespace actformer::ingest {

/// Triangles, counter-clockwise from outside.
struct SkinFigure {
    std::vector<float> positions;       ///< (corners, 3) metres in the rest pose, the root at the origin
    std::vector<float> normals;         ///< (corners, 3) of length 1
    std::vector<std::uint16_t> joints;  ///< (corners, 4) that a corner follows
    std::vector<float> weights;         ///< (corners, 4) by so much; they add up to 1. Joint 0 where it is 0
    std::vector<std::uint32_t> faces;   ///< (triangles, 3) corners; empty: three after the other

    std::size_t corners() const { return joints.size() / 4; }
};

}  // namespace actformer::ingest
