// A learning rate that falls in steps.
#pragma once

#include <cstdint>
#include <vector>

namespace actformer::model {

/// What the rate is multiplied by in epoch `epoch`, counted from 0: `factor` once for every one of `drops` that has come.
inline double rate_share(const std::vector<std::int64_t>& drops, double factor, std::uint64_t epoch) {
    double share = 1;
    for (const auto drop : drops)
        if (epoch >= static_cast<std::uint64_t>(drop)) share *= factor;
    return share;
}

}  // namespace actformer::model
