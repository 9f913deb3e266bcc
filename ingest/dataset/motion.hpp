// A cleaned motion, and its way back to joint positions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ingest/dataset/topology.hpp"

namespace actformer::ingest {

/// values (frames, persons, joints, 3) float32: joint 0 the root's position in metres, the others unit limb vectors
/// from parent to child.
struct Motion {
    std::string name;
    std::uint32_t frames = 0, persons = 0, joints = 0;
    std::vector<float> values;

    const float* at(std::size_t frame, std::size_t person, std::size_t joint) const {
        return &values[((frame * persons + person) * joints + joint) * 3];
    }
};

/// (frames, persons, joints, 3) joint positions in metres. `bone_length` (persons, joints) in metres.
std::vector<float> joint_positions(const Motion& motion, const Topology& topology,
                                   const std::vector<float>& bone_length);

}  // namespace actformer::ingest
