// Action2Motion in the training loop. Includes torch headers.
#pragma once

#include <memory>

#include "model/generators/action2motion/motions.hpp"
#include "model/generators/action2motion/network.hpp"
#include "model/train/network_learner.hpp"
#include "model/train/window_feed.hpp"

namespace actformer::model::action2motion {

/// A step is one batch, fed its own outputs or the truth as a number of the step's decides for the whole batch. The three networks'
/// optimisers, alike in all and always stepped together, are one over all weights.
class MotionLearner : public NetworkLearner {
  public:
    MotionLearner(const Config& config, const Settings& settings, const std::string& where,
                  const LearnerSetup& setup);

    std::uint64_t windows_a_step() const override { return batch_; }
    void step(std::uint64_t step, double rate_share) override;
    Measures losses(const std::vector<double>& sums, std::uint64_t steps) const override;

  private:
    MotionLearner(std::shared_ptr<Network> network, std::uint32_t batch, const std::string& where,
                  const LearnerSetup& setup);

    at::Tensor noise(std::uint64_t step) const;

    std::shared_ptr<Network> network_;
    std::uint32_t batch_;
    MotionNumbers motions_;
    RandomFeed feed_;
};

}  // namespace actformer::model::action2motion
