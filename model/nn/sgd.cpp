#include "model/nn/sgd.hpp"

#include <ATen/core/grad_mode.h>

namespace actformer::model {

Sgd::Sgd(std::vector<at::Tensor> parameters, const SgdSettings& settings)
    : parameters_(std::move(parameters)), settings_(settings) {
    for (const auto& parameter : parameters_) momenta_.push_back(at::zeros_like(parameter).detach());
}

void Sgd::step(double rate) {
    const at::NoGradGuard no_gradients;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        auto& parameter = parameters_[i];
        auto gradient = parameter.grad();
        if (!gradient.defined()) continue;
        gradient.add_(parameter, settings_.weight_decay);
        momenta_[i].mul_(settings_.momentum).add_(gradient);
        if (settings_.nesterov)
            parameter.add_(gradient.add_(momenta_[i], settings_.momentum), -rate);
        else
            parameter.add_(momenta_[i], -rate);
        parameter.mutable_grad().reset();
    }
}

}  // namespace actformer::model
