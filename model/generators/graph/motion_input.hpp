// What a discriminator of graph convolutions is given. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <vector>

namespace actformer::model {

/// Motions (N, C, T, K) and behind their channels the first differences over frames times `gain`; with `order` 2 behind those the second ones times
/// gain squared: (N, (1 + order) * C, T, K). Differences that would need frames before the first are 0.
inline at::Tensor with_differences(const at::Tensor& motion, std::int64_t order = 1, double gain = 1) {
    const auto t = motion.size(2);
    std::vector<at::Tensor> all{motion};
    for (std::int64_t i = 1; i <= order; ++i) {
        const auto& last = all.back();
        auto moved = last.slice(2, i, t) - last.slice(2, i - 1, t - 1);
        if (gain != 1) moved = moved * gain;
        all.push_back(at::cat({at::zeros_like(motion.slice(2, 0, i)), moved}, 2));
    }
    return at::cat(all, 1);
}

/// Numbers (N, C, T, K) as graph convolutions of our own take them, (N, K, padding + T + padding, C), zeros on either side.
inline at::Tensor node_input(const at::Tensor& numbers, std::int64_t padding) {
    return at::constant_pad_nd(numbers.permute({0, 3, 2, 1}), {0, 0, padding, padding}).contiguous();
}

}  // namespace actformer::model
