#include "eval/metrics/fid_infinity.hpp"

#include <algorithm>
#include <iterator>
#include <random>

#include "base/error.hpp"
#include "eval/metrics/fid.hpp"

namespace actformer::eval {
namespace {

using Orders = std::vector<std::vector<std::size_t>>;

/// Every class's samples in a random order.
Orders shuffled(const Samples& samples, std::uint64_t seed) {
    auto orders = members_by_class(samples);
    std::mt19937_64 random(seed);
    for (auto& order : orders)
        for (std::size_t i = order.size(); i > 1; --i)  // Fisher and Yates, the same on every platform
            std::swap(order[i - 1], order[((random() >> 32) * i) >> 32]);
    return orders;
}

Samples beginning(const Samples& from, const Orders& orders, double inverse_share) {
    Samples out;
    out.dimensions = from.dimensions;
    out.classes = from.classes;
    for (const auto& order : orders) {
        const auto count = static_cast<std::size_t>(static_cast<double>(order.size()) / inverse_share);
        for (std::size_t i = 0; i < count; ++i) {
            const auto features = features_of(from, order[i]);
            out.features.insert(out.features.end(), features.begin(), features.end());
            out.labels.push_back(from.labels[order[i]]);
        }
    }
    return out;
}

/// Intercepts of the classes that every subset has a distance of.
std::optional<double> mean_intercept(std::span<const double> x, const std::vector<Distances>& subsets) {
    double sum = 0;
    std::size_t measured = 0;
    for (std::size_t c = 0; c < subsets.back().by_class.size(); ++c) {
        if (!subsets.back().by_class[c]) continue;
        std::vector<double> y;
        for (const auto& subset : subsets) y.push_back(*subset.by_class[c]);
        sum += intercept(x, y);
        ++measured;
    }
    if (measured == 0) return {};
    return sum / static_cast<double>(measured);
}

}  // namespace

double intercept(std::span<const double> x, std::span<const double> y) {
    double mean_x = 0, mean_y = 0, along = 0, squares = 0;
    const auto n = static_cast<double>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += x[i] / n;
        mean_y += y[i] / n;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        along += (x[i] - mean_x) * (y[i] - mean_y);
        squares += (x[i] - mean_x) * (x[i] - mean_x);
    }
    return mean_y - along / squares * mean_x;
}

std::optional<ExtrapolatedFid> fid_infinity(const Samples& real, const Samples& generated, std::uint64_t seed,
                                            unsigned threads) {
    const auto of_real = shuffled(real, seed), of_generated = shuffled(generated, seed + 1);
    const double smallest = *std::rbegin(inverse_shares);
    if (beginning(real, of_real, smallest).size() < 2 ||
        beginning(generated, of_generated, smallest).size() < 2)
        return {};
    std::vector<Distances> subsets;
    std::vector<double> whole;
    for (const auto inverse : inverse_shares) {
        subsets.push_back(distances(statistics_of(beginning(real, of_real, inverse), threads),
                                    statistics_of(beginning(generated, of_generated, inverse), threads),
                                    threads));
        whole.push_back(subsets.back().whole);
    }
    return ExtrapolatedFid{intercept(inverse_shares, whole), mean_intercept(inverse_shares, subsets)};
}

}  // namespace actformer::eval
