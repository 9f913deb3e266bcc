// What a discriminator of graph convolutions is given. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

namespace actformer::model {

/// First differences over frames of numbers (N, C, T, K), times `gain`; 0 in the `still` first frames, one or more.
inline at::Tensor difference(const at::Tensor& numbers, double gain = 1, std::int64_t still = 1) {
    const auto t = numbers.size(2);
    auto moved = numbers.slice(2, still, t) - numbers.slice(2, still - 1, t - 1);
    if (gain != 1) moved = moved * gain;
    return at::cat({at::zeros_like(numbers.slice(2, 0, still)), moved}, 2);
}

/// Numbers (N, C, T, K) as graph convolutions of our own take them, (N, K, padding + T + padding, C), zeros on either side.
inline at::Tensor node_input(const at::Tensor& numbers, std::int64_t padding) {
    return at::constant_pad_nd(numbers.permute({0, 3, 2, 1}), {0, 0, padding, padding}).contiguous();
}

}  // namespace actformer::model
