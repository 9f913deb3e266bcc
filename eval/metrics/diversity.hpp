// Diversity of generated motions (Guo et al., "Action2Motion", ACM MM 2020, section 5.1).
#pragma once

#include <optional>

#include "eval/metrics/samples.hpp"

namespace actformer::eval {

/// Mean Euclidean distance of `pairs` random pairs of samples, a sample never paired with itself. The same seed draws the same
/// pairs. None for fewer than two samples.
std::optional<double> diversity(const Samples& samples, std::size_t pairs = 200, std::uint64_t seed = 0);

}  // namespace actformer::eval
