// Random motions that pass for limb vectors.
#pragma once

#include <algorithm>
#include <cmath>

#include "ingest/dataset/motion.hpp"

namespace actformer::test {

/// Gives every node behind the first the length of 1, as limb vectors have it.
inline void make_unit_limbs(ingest::Motion& motion) {
    for (std::size_t i = 0; i < motion.values.size() / 3; ++i) {
        if (i % motion.nodes == 0) continue;
        float* x = &motion.values[3 * i];
        const float length = std::max(std::hypot(x[0], x[1], x[2]), 1e-6F);
        for (std::size_t d = 0; d < 3; ++d) x[d] /= length;
    }
}

}  // namespace actformer::test
