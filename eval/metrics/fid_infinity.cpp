#include "eval/metrics/fid_infinity.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <random>

#include "base/random/shuffle.hpp"
#include "eval/metrics/fid.hpp"

namespace actformer::eval {
namespace {

using Orders = std::vector<std::vector<std::size_t>>;

/// Every class's samples in a random order.
Orders shuffled(const Samples& samples, std::uint64_t seed) {
    auto orders = members_by_class(samples);
    std::mt19937_64 random(seed);
    for (auto& order : orders) shuffle(order, random);
    return orders;
}

/// What the subset that takes 1 / inverse_share of every class has of it; whole samples, so of few the share is smaller.
std::size_t taken(std::size_t samples, double inverse_share) {
    return static_cast<std::size_t>(static_cast<double>(samples) / inverse_share);
}

/// Classes' numbers of samples.
std::vector<std::size_t> sizes_of(const Orders& orders) {
    std::vector<std::size_t> sizes;
    for (const auto& order : orders) sizes.push_back(order.size());
    return sizes;
}

Samples beginning(const Samples& from, const Orders& orders, double inverse_share) {
    std::vector<std::size_t> which;
    for (const auto& order : orders)
        which.insert(which.end(), order.begin(),
                     order.begin() + static_cast<std::ptrdiff_t>(taken(order.size(), inverse_share)));
    return subset(from, which);
}

/// The distances of a subset and how many samples it has of each class.
struct Subset {
    std::vector<std::size_t> real, generated;
    Distances between;
};

Subset measured(const Samples& real, const Samples& generated, unsigned threads) {
    const auto of_real = statistics_of(real, threads), of_generated = statistics_of(generated, threads);
    return {of_real.counts, of_generated.counts, distances(of_real, of_generated, threads)};
}

/// One divided by the share that was taken, the mean of both sides.
double inverse_share(std::size_t all_real, std::size_t real, std::size_t all_generated,
                     std::size_t generated) {
    return (static_cast<double>(all_real) / static_cast<double>(real) +
            static_cast<double>(all_generated) / static_cast<double>(generated)) /
           2;
}

std::size_t total(const std::vector<std::size_t>& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

double whole_intercept(const std::vector<Subset>& subsets) {
    const auto& all = subsets[0];
    std::vector<double> x, y;
    for (const auto& part : subsets) {
        x.push_back(
            inverse_share(total(all.real), total(part.real), total(all.generated), total(part.generated)));
        y.push_back(part.between.whole);
    }
    return intercept(x, y);
}

/// Of the classes that every subset has a distance of.
std::optional<double> mean_intercept(const std::vector<Subset>& subsets) {
    const auto& all = subsets[0];
    double sum = 0;
    std::size_t classes = 0;
    for (std::size_t c = 0; c < all.real.size(); ++c) {
        if (!subsets.back().between.by_class[c]) continue;
        std::vector<double> x, y;
        for (const auto& part : subsets) {
            x.push_back(inverse_share(all.real[c], part.real[c], all.generated[c], part.generated[c]));
            y.push_back(*part.between.by_class[c]);
        }
        sum += intercept(x, y);
        ++classes;
    }
    if (classes == 0) return {};
    return sum / static_cast<double>(classes);
}

}  // namespace

std::size_t in_smallest_subset(std::span<const std::size_t> counts) {
    std::size_t out = 0;
    for (const auto samples : counts) out += taken(samples, *std::rbegin(inverse_shares));
    return out;
}

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
    if (in_smallest_subset(sizes_of(of_real)) < 2 || in_smallest_subset(sizes_of(of_generated)) < 2)
        return {};
    std::vector<Subset> subsets;
    for (const auto inverse : inverse_shares)
        subsets.push_back(measured(beginning(real, of_real, inverse),
                                   beginning(generated, of_generated, inverse), threads));
    return ExtrapolatedFid{whole_intercept(subsets), mean_intercept(subsets)};
}

}  // namespace actformer::eval
