// Windows of a feed as tensors. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <cstdint>

#include "model/train/window_feed.hpp"

namespace actformer::model {

/// Windows on their way to `device`: (count, channels, frames, joints) float32, and their labels (count) int64. On the
/// CPU the values are the feed's own memory, good until it moves on.
at::Tensor values_of(const Windows& windows, std::int64_t channels, std::int64_t frames, std::int64_t joints,
                     const at::Device& device);
at::Tensor labels_of(const Windows& windows, const at::Device& device);

}  // namespace actformer::model
