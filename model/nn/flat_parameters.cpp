#include "model/nn/flat_parameters.hpp"

#include <ATen/core/grad_mode.h>
#include <algorithm>

namespace actformer::model {
namespace {

constexpr std::int64_t vector = 16;  // numbers of 64 bytes

std::int64_t room_for(const at::Tensor& parameter) {
    return (parameter.numel() + vector - 1) / vector * vector;
}

}  // namespace

FlatParameters::FlatParameters(std::vector<at::Tensor> parameters, std::int64_t appended)
    : parameters_(std::move(parameters)) {
    std::int64_t count = 0;
    for (const auto& parameter : parameters_) count += room_for(parameter);
    const auto options =
        at::TensorOptions(at::kFloat).device(parameters_.empty() ? at::kCPU : parameters_[0].device());
    values_ = at::zeros({count}, options);
    all_reduce_buffer_ = at::zeros({count + appended}, options);
    gradients_ = all_reduce_buffer_.narrow(0, 0, count);
    appended_values_ = all_reduce_buffer_.narrow(0, count, appended);
    const at::NoGradGuard no_gradients;
    std::int64_t first = 0;
    for (auto& parameter : parameters_) {
        const auto part = [&](const at::Tensor& all) {
            return all.narrow(0, first, parameter.numel()).view(parameter.sizes());
        };
        part(values_).copy_(parameter);
        parameter.set_data(part(values_));
        parameter.mutable_grad() = part(gradients_);
        first += room_for(parameter);
    }
}

void FlatParameters::zero_gradients() {
    gradients_.zero_();
}

void FlatParameters::follow(const FlatParameters& latest, double decay, std::uint64_t steps) {
    const auto t = static_cast<double>(steps);
    values_.lerp_(latest.values_, 1 - std::min(decay, (1 + t) / (10 + t)));
}

void FlatParameters::want_gradients(bool wanted) {
    for (auto& parameter : parameters_) parameter.set_requires_grad(wanted);
}

}  // namespace actformer::model
