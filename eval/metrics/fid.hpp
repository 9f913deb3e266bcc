// The Frechet distances of the tables: FIDw over all samples, FIDm as the mean over classes, FIDa over groups.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "eval/metrics/frechet.hpp"
#include "eval/metrics/samples.hpp"

namespace actformer::eval {

/// The Gaussians of all samples and of each class. Made once for the real side and used for every generated one.
struct Statistics {
    std::size_t samples = 0;
    std::vector<std::size_t> counts;               ///< (classes) samples
    Moments whole;                                 ///< of all samples
    std::vector<std::optional<Moments>> by_class;  ///< (classes) where there are two samples or more
};

/// Of each class with two samples or more. `threads` 0: one a core; the numbers are the same on any.
std::vector<std::optional<Moments>> moments_by_class(const Samples& samples, unsigned threads = 0);

/// Of all and of each class. Throws Error for fewer than two samples in all.
Statistics statistics_of(const Samples& samples, unsigned threads = 0);

/// A class with fewer than two samples on a side: it has no distance.
struct LeftOut {
    std::size_t label = 0, real = 0, generated = 0;  ///< the class and its samples
};

struct Distances {
    double whole = 0;                             ///< FIDw, over all samples
    std::optional<double> mean;                   ///< FIDm, over the classes not left out; none where all are
    std::vector<std::optional<double>> by_class;  ///< (classes)
    std::vector<LeftOut> left_out;
};

/// Of each class that has moments on both sides. Throws Error where classes or dimensions differ.
std::vector<std::optional<double>> distances_by_class(const std::vector<std::optional<Moments>>& real,
                                                      const std::vector<std::optional<Moments>>& generated,
                                                      unsigned threads = 0);

/// Throws Error where classes or dimensions differ.
Distances distances(const Statistics& real, const Statistics& generated, unsigned threads = 0);

/// One sample a group from the features of its persons (groups * persons, dimensions): the largest value of every channel.
/// FIDa_w and FIDa_m are the distances of such samples, the features being a one-person recogniser's.
std::vector<float> largest_of_group(std::span<const float> features, std::size_t dimensions,
                                    std::size_t persons);

}  // namespace actformer::eval
