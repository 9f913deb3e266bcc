// Sizes that kernels want whole.
#pragma once

#include <cstddef>

namespace actformer::kernels {

/// The least multiple of `step` that is not below `value`.
constexpr std::size_t round_up(std::size_t value, std::size_t step) {
    return (value + step - 1) / step * step;
}

}  // namespace actformer::kernels
