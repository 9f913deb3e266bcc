// Samples as a recogniser sees them: what every metric is made from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace actformer::eval {

/// n samples as the recogniser sees them.
struct Samples {
    std::size_t dimensions = 0, classes = 0;
    std::vector<double> features;       ///< (n, dimensions)
    std::vector<float> logits;          ///< (n, classes), or empty where no accuracy is asked for
    std::vector<std::uint32_t> labels;  ///< (n) each below `classes`

    std::size_t size() const { return labels.size(); }
};

/// Features (dimensions) of sample `i`.
std::span<const double> features_of(const Samples& samples, std::size_t i);

/// Which samples each class has, (classes).
std::vector<std::vector<std::size_t>> members_by_class(const Samples& samples);

/// 0 1 .. n-1
std::vector<std::size_t> all_indices(std::size_t n);

/// Those samples in that order.
Samples subset(const Samples& from, const std::vector<std::size_t>& which);

/// Throws Error, beginning with `where`, for shapes that do not fit together, no samples, labels that are no class, or
/// features and logits that are not finite.
void check(const Samples& samples, const std::string& where);

}  // namespace actformer::eval
