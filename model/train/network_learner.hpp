// Learners of one network that Adam moves: its optimiser, the EMA of its weights and what a checkpoint holds of them. Includes torch
// headers.
#pragma once

#include <torch/nn/module.h>

#include <memory>
#include <optional>
#include <vector>

#include "model/nn/adam.hpp"
#include "model/train/learner.hpp"

namespace actformer::model {

class NetworkLearner : public Learner {
  public:
    at::Tensor& sums() override { return sums_; }
    bool finite() override;
    std::vector<Array> state() override;
    void load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) override;
    void broadcast(std::uint64_t steps) override;
    std::vector<Array> weights() override;
    bool keeps_ema() const override { return ema_ != nullptr; }
    std::vector<Array> ema_weights() override;

  protected:
    /// `ema`, a network like `network`, takes the EMA of its weights, of decay `average` a step; none is kept where it is null. Every step
    /// has as many numbers to tell as `losses`. Every process begins with the weights of rank 0.
    NetworkLearner(std::shared_ptr<torch::nn::Module> network, std::shared_ptr<torch::nn::Module> ema,
                   const AdamSettings& adam, double average, std::int64_t losses, const LearnerSetup& setup);

    const LearnerSetup& setup() const { return setup_; }
    FlatParameters& parameters() { return parameters_; }

    /// Behind a backward pass: means over the processes of the gradients and of `losses` (losses), which `sums` gets too.
    void all_reduce_mean(const at::Tensor& losses);

    /// Moves the weights along their gradients, and their EMA.
    void move(double rate_share);

  private:
    std::vector<at::Tensor> optimiser_state();

    LearnerSetup setup_;
    std::shared_ptr<torch::nn::Module> network_, ema_;
    double decay_;  ///< of the EMA, a step
    FlatParameters parameters_;
    std::optional<FlatParameters> ema_parameters_;  ///< where an EMA is kept
    Adam adam_;
    at::Tensor sums_;
};

}  // namespace actformer::model
