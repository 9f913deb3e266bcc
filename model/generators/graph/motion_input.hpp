// What a discriminator of graph convolutions is given. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <vector>

#include "model/nn/fused.hpp"

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

/// The same as graph convolutions take it, (N, K, padding + T + padding, channels), zeros on either side. `fused` takes a kernel of our own,
/// on processors, for what the paper's discriminator sees.
inline at::Tensor padded_differences(const at::Tensor& motion, std::int64_t padding, bool fused,
                                     std::int64_t order = 1, double gain = 1) {
    if (fused && order == 1 && gain == 1) return fused_motion_input(motion.contiguous(), padding);
    const auto seen = with_differences(motion, order, gain).permute({0, 3, 2, 1});
    return at::constant_pad_nd(seen, {0, 0, padding, padding}).contiguous();
}

}  // namespace actformer::model
