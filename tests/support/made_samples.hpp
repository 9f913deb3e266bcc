// Samples of known classes without a recogniser.
#pragma once

#include <random>

#include "eval/metrics/samples.hpp"

namespace actformer::test {

/// Class c has counts[c] samples around a centre of its own; `spread` stretches them.
inline eval::Samples made_samples(const std::vector<std::size_t>& counts, std::size_t dimensions,
                                  unsigned seed, float spread = 1) {
    std::mt19937 random(seed), centres(99);
    std::normal_distribution<float> normal;
    eval::Samples out;
    out.dimensions = dimensions;
    out.classes = counts.size();
    for (std::uint32_t c = 0; c < counts.size(); ++c) {
        std::vector<float> centre(dimensions);
        for (auto& v : centre) v = normal(centres);
        for (std::size_t i = 0; i < counts[c]; ++i) {
            for (const auto v : centre) out.features.push_back(v + spread * normal(random));
            for (std::uint32_t k = 0; k < counts.size(); ++k)
                out.logits.push_back(normal(random) + (k == c ? 1.5F : 0));
            out.labels.push_back(c);
        }
    }
    return out;
}

}  // namespace actformer::test
