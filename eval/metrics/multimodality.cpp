#include "eval/metrics/multimodality.hpp"

namespace actformer::eval {

std::optional<double> multimodality(const Samples& samples, std::size_t pairs, std::uint64_t seed,
                                    PairsDrawn drawn) {
    PairRandom random(seed);
    const std::size_t fewest = drawn == PairsDrawn::with_replacement ? 1 : 2;
    double sum = 0;
    std::size_t measured = 0;
    for (const auto& members : members_by_class(samples)) {
        if (members.size() < fewest || pairs == 0) continue;
        sum += mean_pair_distance(samples, members, pairs, random, drawn);
        ++measured;
    }
    if (measured == 0) return {};
    return sum / static_cast<double>(measured);
}

}  // namespace actformer::eval
