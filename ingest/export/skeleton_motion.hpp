// A motion as BVH and glTF hold it: a skeleton in a rest pose, and how each joint turns against its parent.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ingest/dataset/quaternion.hpp"
#include "ingest/dataset/topology.hpp"

namespace actformer::ingest {

using Point = std::array<double, 3>;

/// One person. With R and X the rotation and the place of a joint in the world, p its parent and t a frame:
/// R_j(t) = R_p(t) rotation_j(t), X_j(t) = X_p(t) + R_p(t) position_j(t).
struct SkeletonMotion {
    Topology topology;
    std::uint32_t frames = 0;
    std::vector<Point> rest;  ///< (K) metres from the parent while nothing is turned; the root's is 0
    std::vector<Quaternion>
        rotation;                 ///< (frames, K) against the parent; consecutive ones lie in one half space
    std::vector<Point> position;  ///< (frames, K) metres from the parent; the root's in the world
    std::vector<bool>
        slides;  ///< (K) true for the root, and where the position leaves `rest`; else it is `rest`

    std::size_t joints() const { return rest.size(); }
    const Quaternion& turn(std::size_t frame, std::size_t joint) const {
        return rotation[frame * joints() + joint];
    }
    const Point& place(std::size_t frame, std::size_t joint) const {
        return position[frame * joints() + joint];
    }
};

}  // namespace actformer::ingest
