// Distances of random pairs of samples.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "eval/metrics/samples.hpp"

namespace actformer::eval {

using PairRandom = std::mt19937_64;

/// Mean Euclidean distance of `pairs` random pairs among the samples `which`, of which there are two or more. A sample is
/// never paired with itself.
double mean_pair_distance(const Samples& samples, const std::vector<std::size_t>& which, std::size_t pairs,
                          PairRandom& random);

}  // namespace actformer::eval
