// Action2Motion in the training loop. Includes torch headers.
#pragma once

#include <memory>
#include <optional>

#include "model/generators/action2motion/motions.hpp"
#include "model/generators/action2motion/network.hpp"
#include "model/nn/adam.hpp"
#include "model/train/learner.hpp"
#include "model/train/window_feed.hpp"

namespace actformer::model::action2motion {

/// A step is one batch, fed its own outputs or the truth as a number of the step's decides for the whole batch. The three networks'
/// optimisers, alike in all and always stepped together, are one over all weights.
class MotionLearner : public Learner {
  public:
    MotionLearner(const Config& config, const Settings& settings, const std::string& where,
                  const LearnerSetup& setup);

    std::uint64_t windows_a_step() const override { return batch_; }
    void step(std::uint64_t step, double rate_share) override;
    at::Tensor& sums() override { return sums_; }
    Measures losses(const std::vector<double>& sums, std::uint64_t steps) const override;
    bool finite() override;
    std::vector<Array> state() override;
    void load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) override;
    void share(std::uint64_t steps) override;
    std::vector<Array> weights() override;
    bool keeps_ema() const override { return ema_ != nullptr; }
    std::vector<Array> ema_weights() override;

  private:
    at::Tensor noise(std::uint64_t step) const;
    std::vector<at::Tensor> optimiser_state();

    Settings settings_;
    std::uint32_t batch_;
    LearnerSetup setup_;
    MotionNumbers motions_;
    RandomFeed feed_;
    Network network_;
    std::unique_ptr<Network> ema_;  ///< where an EMA is kept
    FlatParameters parameters_;
    std::optional<FlatParameters> ema_parameters_;
    Adam adam_;
    at::Tensor sums_;
};

}  // namespace actformer::model::action2motion
