// Features in two dimensions: the first two principal components of the real side.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "eval/metrics/samples.hpp"

namespace actformer::reports {

/// Points of samples evenly chosen, in units of 1/4096 of the real side's standard deviation along each axis; further out than 8
/// deviations they lie at 8.
struct Points {
    std::vector<std::int16_t> xy;       ///< (n, 2)
    std::vector<std::uint16_t> labels;  ///< (n)
};

class Projection {
  public:
    /// Of at least two real samples. Throws Error for more than 4096 dimensions.
    explicit Projection(const eval::Samples& real);

    const Points& real() const { return real_; }
    const std::array<double, 2>& explained() const { return explained_; }  ///< shares of the variance

    /// Throws Error where the samples have other dimensions.
    Points of(const eval::Samples& samples) const;

  private:
    std::size_t dimensions_;
    std::vector<double> mean_, axes_;  ///< (dimensions); (2, dimensions), each over its deviation
    std::array<double, 2> explained_{};
    Points real_;
};

}  // namespace actformer::reports
