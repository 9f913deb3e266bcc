#include "eval/metrics/multimodality.hpp"

#include "eval/metrics/pairs.hpp"

namespace actformer::eval {

std::optional<double> multimodality(const Samples& samples, std::size_t pairs, std::uint64_t seed) {
    PairRandom random(seed);
    double sum = 0;
    std::size_t measured = 0;
    for (const auto& members : members_by_class(samples)) {
        if (members.size() < 2 || pairs == 0) continue;
        sum += mean_pair_distance(samples, members, pairs, random);
        ++measured;
    }
    if (measured == 0) return {};
    return sum / static_cast<double>(measured);
}

}  // namespace actformer::eval
