// A random order that is the same on every platform, as std::shuffle's is not.
#pragma once

#include <random>
#include <utility>
#include <vector>

namespace actformer {

/// Every order is as likely as any other (Fisher and Yates).
template <typename T>
void shuffle(std::vector<T>& values, std::mt19937_64& random) {
    for (std::size_t i = values.size(); i > 1; --i)
        std::swap(values[i - 1], values[((random() >> 32) * i) >> 32]);
}

}  // namespace actformer
