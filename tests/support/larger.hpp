// The largest of differences, in which no NaN is lost.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace actformer::test {

/// The larger of the two; infinity where either is NaN, which std::max(largest, NaN) would pass over.
inline double larger(double largest, double difference) {
    if (std::isnan(largest) || std::isnan(difference)) return std::numeric_limits<double>::infinity();
    return std::max(largest, difference);
}

}  // namespace actformer::test
