// What a discriminator of graph convolutions is given. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

namespace actformer::model {

/// The differences from frame to frame behind the channels of motions (N, C, T, K), (N, 2C, T, K); the first frame's are 0.
inline at::Tensor with_differences(const at::Tensor& motion) {
    const auto t = motion.size(2);
    const auto moved = motion.slice(2, 1, t) - motion.slice(2, 0, t - 1);
    return at::cat({motion, at::cat({at::zeros_like(motion.slice(2, 0, 1)), moved}, 2)}, 1);
}

}  // namespace actformer::model
