// Kernel inception distance (Binkowski et al., ICLR 2018): the squared maximum mean discrepancy of two sets of features under the
// kernel k(x, y) = (x.y / d + 1)^3, d the dimensions. Unlike a FID it has no bias in the number of samples.
#pragma once

#include <optional>

#include "eval/metrics/samples.hpp"

namespace actformer::eval {

/// The unbiased estimate, over all pairs of samples and not over blocks of them: mean of k over pairs of different real samples,
/// plus the same of generated ones, minus twice the mean over real and generated. It may be below 0. `threads` 0: one a core;
/// the number is the same on any. None with fewer than two samples on a side. Throws Error where the dimensions differ.
std::optional<double> kid(const Samples& real, const Samples& generated, unsigned threads = 0);

/// The mean of every class's own, over the classes with two samples or more on both sides; none where there is none.
std::optional<double> kid_mean(const Samples& real, const Samples& generated, unsigned threads = 0);

}  // namespace actformer::eval
