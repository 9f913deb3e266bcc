#include "eval/metrics/pairs.hpp"

#include <cmath>

namespace actformer::eval {
namespace {

double distance(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
}

/// Below `n`, every number as likely to 2^-32 n.
std::size_t draw(PairRandom& random, std::size_t n) {
    return static_cast<std::size_t>(((random() >> 32) * n) >> 32);
}

}  // namespace

double mean_pair_distance(const Samples& samples, const std::vector<std::size_t>& which, std::size_t pairs,
                          PairRandom& random, PairsDrawn drawn) {
    double sum = 0;
    for (std::size_t i = 0; i < pairs; ++i) {
        const auto one = draw(random, which.size());
        const bool any = drawn == PairsDrawn::with_replacement;
        auto other = draw(random, any ? which.size() : which.size() - 1);
        if (!any && other >= one) ++other;
        sum += distance(features_of(samples, which[one]), features_of(samples, which[other]));
    }
    return sum / static_cast<double>(pairs);
}

}  // namespace actformer::eval
