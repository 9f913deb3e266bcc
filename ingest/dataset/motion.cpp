#include "ingest/dataset/motion.hpp"

namespace actformer::ingest {

std::vector<float> joint_positions(const Motion& motion, const Topology& topology,
                                   const std::vector<float>& bone_length) {
    std::vector<float> out(motion.values.size());
    const auto order = topology.order();
    for (std::size_t t = 0; t < motion.frames; ++t)
        for (std::size_t p = 0; p < motion.persons; ++p) {
            float* body = &out[(t * motion.persons + p) * motion.joints * 3];
            for (const auto j : order) {
                const float* limb = motion.at(t, p, j);
                const int parent = topology.parents[j];
                const float length = parent < 0 ? 1.0F : bone_length[p * motion.joints + j];
                for (std::size_t d = 0; d < 3; ++d)
                    body[j * 3 + d] = limb[d] * length + (parent < 0 ? 0.0F : body[parent * 3 + d]);
            }
        }
    return out;
}

}  // namespace actformer::ingest
