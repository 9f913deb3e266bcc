// Distances of random pairs of samples.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "eval/metrics/samples.hpp"

namespace actformer::eval {

using PairRandom = std::mt19937_64;

enum class PairsDrawn {
    of_different_samples,
    with_replacement  ///< either of a pair is drawn from all, so that it may be a sample twice
};

/// Mean Euclidean distance of `pairs` random pairs among the samples `which`, of which there are two or
/// more, or one where they are drawn with replacement.
double mean_pair_distance(const Samples& samples, const std::vector<std::size_t>& which, std::size_t pairs,
                          PairRandom& random, PairsDrawn drawn = PairsDrawn::of_different_samples);

}  // namespace actformer::eval
