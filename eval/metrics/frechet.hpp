// The Frechet distance of the Gaussians fitted to two sets of samples, exact with fewer samples than dimensions too:
//
//   d2(X, Y) = |mean X - mean Y|^2 + tr Cx + tr Cy - 2 |X0 Y0^T|_* / sqrt((n - 1)(m - 1))
//
// with X0 (n, d) and Y0 (m, d) the centred samples, Cx and Cy their covariances over n - 1 and m - 1, and |.|_* the nuclear
// norm, the sum of the singular values. No covariance is multiplied and no matrix root taken, so singular ones do no harm.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace actformer::eval {

/// A Gaussian fitted to samples, kept as the distance needs it.
struct Moments {
    std::size_t samples = 0;   ///< n, at least 2
    std::vector<double> mean;  ///< (d)
    double variance = 0;       ///< tr C: the dimensions' variances over n - 1, summed
    std::vector<double>
        factor;  ///< (rows, d) with factor^T factor = (n - 1) C; rows is n or, of many samples, d

    std::size_t dimensions() const { return mean.size(); }
};

/// Of samples (n, dimensions), row after row. The same samples give the same numbers on any number of `threads` (0: one a
/// core). Throws Error for fewer than two samples, or a number that is not finite.
Moments fit(std::span<const double> samples, std::size_t dimensions, unsigned threads = 1);

/// d2 of two sets of as many dimensions: never negative, and 0 where it is less than rounding can tell from it (1e-13 of the
/// variances), as for the same samples in any order. Throws Error where the dimensions differ.
double frechet_distance(const Moments& x, const Moments& y);

}  // namespace actformer::eval
