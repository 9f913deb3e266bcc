#include "model/train/network_learner.hpp"

#include <ATen/core/grad_mode.h>

#include <utility>

#include "model/nn/module_arrays.hpp"

namespace actformer::model {

NetworkLearner::NetworkLearner(std::shared_ptr<torch::nn::Module> network,
                               std::shared_ptr<torch::nn::Module> ema, const AdamSettings& adam,
                               double average, std::int64_t losses, const LearnerSetup& setup)
    : setup_(setup),
      network_(std::move(network)),
      ema_(std::move(ema)),
      decay_(average),
      parameters_(network_->parameters(), losses),
      adam_(parameters_, adam),
      sums_(at::zeros({losses}, at::TensorOptions(at::kDouble).device(setup.device))) {
    if (ema_) ema_parameters_.emplace(ema_->parameters());
    broadcast(0);
}

void NetworkLearner::all_reduce_mean(const at::Tensor& losses) {
    parameters_.appended_values().copy_(losses.detach());
    setup_.processes.all_reduce_mean(parameters_.all_reduce_buffer());
    sums_.add_(parameters_.appended_values());
}

void NetworkLearner::move(double rate_share) {
    adam_.step(rate_share);
    if (ema_parameters_) ema_parameters_->follow(parameters_, decay_, adam_.steps);
}

bool NetworkLearner::finite() {
    return at::isfinite(parameters_.values()).all().item<bool>();
}

/// What is not a weight of the network, but belongs to the state.
std::vector<at::Tensor> NetworkLearner::optimiser_state() {
    std::vector<at::Tensor> all{adam_.squares()};
    if (adam_.means().defined()) all.push_back(adam_.means());
    if (ema_parameters_) all.push_back(ema_parameters_->values());
    return all;
}

std::vector<Array> NetworkLearner::state() {
    auto all = arrays_of(*network_, "network.");
    add_state(all, optimiser_state());
    return all;
}

void NetworkLearner::load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) {
    adam_.steps = steps;
    load_arrays(*network_, "network.", state, where);
    load_state(optimiser_state(), state, where);
}

void NetworkLearner::broadcast(std::uint64_t steps) {
    adam_.steps = steps;
    const at::NoGradGuard no_gradients;
    setup_.processes.broadcast(parameters_.values());
    for (auto& tensor : optimiser_state()) setup_.processes.broadcast(tensor);
}

std::vector<Array> NetworkLearner::weights() {
    return arrays_of(*network_, "");
}

std::vector<Array> NetworkLearner::ema_weights() {
    return ema_ ? arrays_of(*ema_, "") : weights();
}

}  // namespace actformer::model
