#include "model/nn/adam.hpp"

#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>

#include <cmath>

#include "model/cpu/layer_clock.hpp"

namespace actformer::model {

Adam::Adam(FlatParameters& parameters, const AdamSettings& settings)
    : parameters_(&parameters), settings_(settings) {
    squares_ = at::zeros_like(parameters.values());
    if (settings.beta1 > 0) means_ = at::zeros_like(squares_);
    if (!squares_.is_cpu()) scratch_ = at::empty_like(squares_);
}

void Adam::step(double share) {
    const LayerTimer timer("Adam");
    ++steps;
    const auto t = static_cast<double>(steps);
    const double rate = share * settings_.rate;
    const Scales scales{rate / (1 - std::pow(settings_.beta1, t)),
                        std::sqrt(1 - std::pow(settings_.beta2, t)), 1 - rate * settings_.weight_decay};
    squares_.is_cpu() ? step_here(scales) : step_in_operators(scales);
}

/// One pass over memory instead of one an operator.
void Adam::step_here(const Scales& scales) {
    const auto b1 = static_cast<float>(settings_.beta1), b2 = static_cast<float>(settings_.beta2);
    const auto step = static_cast<float>(scales.rate), over = static_cast<float>(1 / scales.root),
               keep = static_cast<float>(scales.keep), epsilon = static_cast<float>(settings_.epsilon);
    auto* value = parameters_->values().data_ptr<float>();
    const auto* gradient = parameters_->gradients().data_ptr<float>();
    auto* mean = means_.defined() ? means_.data_ptr<float>() : nullptr;
    auto* square = squares_.data_ptr<float>();
    at::parallel_for(0, squares_.numel(), 1 << 15, [=](std::int64_t first, std::int64_t last) {
        for (std::int64_t i = first; i < last; ++i) {
            const float g = gradient[i];
            square[i] = b2 * square[i] + (1 - b2) * g * g;
            const float m = mean ? mean[i] = b1 * mean[i] + (1 - b1) * g : g;
            value[i] = keep * value[i] - step * m / (std::sqrt(square[i]) * over + epsilon);
        }
    });
}

void Adam::step_in_operators(const Scales& scales) {
    const at::NoGradGuard no_gradients;
    const auto& gradient = parameters_->gradients();
    squares_.mul_(settings_.beta2).addcmul_(gradient, gradient, 1 - settings_.beta2);
    at::sqrt_out(scratch_, squares_);
    scratch_.div_(scales.root).add_(settings_.epsilon);
    if (means_.defined()) means_.lerp_(gradient, 1 - settings_.beta1);
    if (scales.keep != 1) parameters_->values().mul_(scales.keep);
    parameters_->values().addcdiv_(means_.defined() ? means_ : gradient, scratch_, -scales.rate);
}

}  // namespace actformer::model
