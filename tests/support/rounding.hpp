// What float32's rounding comes to.
#pragma once

#include <ATen/ATen.h>

namespace actformer::test {

/// Root mean square of float32's rounding, in units of 2^-24 of the spread of what is exact.
inline double rounding(const at::Tensor& rounded, const at::Tensor& exact) {
    return ((rounded.to(at::kDouble) - exact).pow(2).mean() / exact.var()).sqrt().item<double>() * 0x1p24;
}

}  // namespace actformer::test
