// A cleaned motion in numbers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace actformer::ingest {

/// values (frames, persons, nodes, numbers) float32, as the motion's representation has them.
struct Motion {
    std::string name;
    std::uint32_t frames = 0, persons = 0, nodes = 0, numbers = 3;
    std::vector<float> values;

    const float* at(std::size_t frame, std::size_t person, std::size_t node) const {
        return &values[((frame * persons + person) * nodes + node) * numbers];
    }
};

/// Whether the numbers could be limbs: over half of the nodes behind the first are as long as a unit vector, within a twentieth.
/// Positions of joints are not. True for a motion of one node.
bool has_unit_limbs(const Motion& motion);

}  // namespace actformer::ingest
