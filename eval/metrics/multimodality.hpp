// Multimodality: how much the motions of one class vary (Guo et al., "Action2Motion", ACM MM 2020, section 5.1).
#pragma once

#include <optional>

#include "eval/metrics/pairs.hpp"

namespace actformer::eval {

/// Mean over the classes that have two samples or more of the mean distance of `pairs` random pairs within the class. None
/// where no class has them. Pairs drawn with replacement take classes of a single sample too, as ACTOR's code does.
std::optional<double> multimodality(const Samples& samples, std::size_t pairs = 20, std::uint64_t seed = 0,
                                    PairsDrawn drawn = PairsDrawn::of_different_samples);

}  // namespace actformer::eval
