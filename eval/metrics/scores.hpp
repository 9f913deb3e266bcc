// What a set of generated samples is worth beside a set of real ones (DESIGN 4.9), from the recogniser's features and logits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eval/metrics/confusion.hpp"
#include "eval/metrics/frechet.hpp"

namespace actformer::eval {

/// n samples as the recogniser sees them.
struct Samples {
    std::size_t dimensions = 0, classes = 0;
    std::vector<double> features;       ///< (n, dimensions)
    std::vector<float> logits;          ///< (n, classes), or empty where no accuracy is asked for
    std::vector<std::uint32_t> labels;  ///< (n) each below `classes`

    std::size_t size() const { return labels.size(); }
};

/// Throws Error, beginning with `where`, for shapes that do not fit together, no samples, labels that are no class, or
/// features and logits that are not finite.
void check(const Samples& samples, const std::string& where);

/// Label against largest logit (of equal ones the first). Its mean_class_accuracy() is the accuracy of the tables: the mean
/// over the classes that have samples of the share recognised.
Confusion confusion_of(const Samples& samples);

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

/// Mean Euclidean distance of `pairs` random pairs of samples, a sample never paired with itself. The same seed draws the same
/// pairs. None for fewer than two samples.
std::optional<double> diversity(const Samples& samples, std::size_t pairs = 200, std::uint64_t seed = 0);

/// Mean over the classes that have two samples or more of the mean distance of `pairs` random pairs within the class. None
/// where no class has them.
std::optional<double> multimodality(const Samples& samples, std::size_t pairs = 20, std::uint64_t seed = 0);

}  // namespace actformer::eval
