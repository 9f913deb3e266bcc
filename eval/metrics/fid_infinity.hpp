// FID without its bias of finite sets (Chong and Forsyth, CVPR 2020): to first order a FID of n samples is above that of
// infinitely many by a constant over n. FIDs of random subsets of both sides, a line through them over one divided by the share
// that each has in fact, and where the line meets 0.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "eval/metrics/samples.hpp"

namespace actformer::eval {

/// One divided by the shares of every class that are taken on both sides, rounded down to whole samples.
constexpr double inverse_shares[] = {1, 1.5, 2, 2.5, 3, 3.5, 4};

/// Of classes with so many samples, how many the smallest subset takes.
std::size_t in_smallest_subset(std::span<const std::size_t> counts);

/// With fewer samples on a side the smallest subset has less than two of a class.
constexpr std::size_t least_of_class = 8;

struct ExtrapolatedFid {
    double whole = 0;  ///< of all samples
    std::optional<double>
        mean;  ///< over the classes with two samples or more on both sides in the smallest subset
};

/// `seed` decides on the subsets: each takes the first samples of one random order a class and side. None with fewer than
/// two samples on a side in the smallest subset. Throws Error where classes or dimensions differ.
std::optional<ExtrapolatedFid> fid_infinity(const Samples& real, const Samples& generated,
                                            std::uint64_t seed = 0, unsigned threads = 0);

/// Where the line of least squares through (x, y), two points or more, meets x = 0.
double intercept(std::span<const double> x, std::span<const double> y);

}  // namespace actformer::eval
