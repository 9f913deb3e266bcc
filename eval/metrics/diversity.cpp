#include "eval/metrics/diversity.hpp"

#include "eval/metrics/pairs.hpp"

namespace actformer::eval {

std::optional<double> diversity(const Samples& samples, std::size_t pairs, std::uint64_t seed) {
    if (samples.size() < 2 || pairs == 0) return {};
    PairRandom random(seed);
    return mean_pair_distance(samples, all_indices(samples.size()), pairs, random);
}

}  // namespace actformer::eval
