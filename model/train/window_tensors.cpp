#include "model/train/window_tensors.hpp"

#include <algorithm>

namespace actformer::model {
namespace {

/// To a GPU by way of memory that it can read while the processor goes on.
at::Tensor sent(const at::Tensor& values, const at::Device& device) {
    if (device.is_cpu()) return values;
    return values.pin_memory().to(device, values.scalar_type(), /*non_blocking=*/true);
}

}  // namespace

at::Tensor values_of(const Windows& windows, std::int64_t channels, std::int64_t frames, std::int64_t joints,
                     const at::Device& device) {
    // from_blob takes no const, and no learner writes to what it learns from.
    auto* const numbers = const_cast<float*>(windows.values);
    return sent(at::from_blob(numbers, {windows.count, channels, frames, joints}, at::kFloat), device);
}

at::Tensor labels_of(const Windows& windows, const at::Device& device) {
    auto labels = at::empty({windows.count}, at::kLong);
    std::copy_n(windows.labels, windows.count, labels.data_ptr<std::int64_t>());
    return sent(labels, device);
}

}  // namespace actformer::model
