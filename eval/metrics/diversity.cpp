#include "eval/metrics/diversity.hpp"

#include <numeric>

#include "eval/metrics/pairs.hpp"

namespace actformer::eval {

std::optional<double> diversity(const Samples& samples, std::size_t pairs, std::uint64_t seed) {
    if (samples.size() < 2 || pairs == 0) return {};
    std::vector<std::size_t> all(samples.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    PairRandom random(seed);
    return mean_pair_distance(samples, all, pairs, random);
}

}  // namespace actformer::eval
