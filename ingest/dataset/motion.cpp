#include "ingest/dataset/motion.hpp"

#include <cmath>

namespace actformer::ingest {

bool has_unit_limbs(const Motion& motion) {
    if (motion.numbers != 3) return false;
    std::size_t unit = 0, all = 0;
    for (std::size_t t = 0; t < motion.frames; ++t)
        for (std::size_t p = 0; p < motion.persons; ++p)
            for (std::size_t k = 1; k < motion.nodes; ++k, ++all) {
                const float* x = motion.at(t, p, k);
                unit += std::abs(std::hypot(x[0], x[1], x[2]) - 1) <= 0.05F;
            }
    return 2 * unit >= all;
}

}  // namespace actformer::ingest
