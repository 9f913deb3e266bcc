// ACTOR in the training loop. Includes torch headers.
#pragma once

#include <memory>
#include <optional>

#include "model/generators/actor/losses.hpp"
#include "model/train/network_learner.hpp"
#include "model/train/window_feed.hpp"

namespace actformer::model {

class ActorLearner : public NetworkLearner {
  public:
    ActorLearner(const ActorSettings& settings, const ActorTraining& training, const MotionSpec& spec,
                 const LearnerSetup& setup);

    std::uint64_t windows_a_step() const override { return training_.batch; }
    void step(std::uint64_t step, double rate_share) override;
    Measures losses(const std::vector<double>& sums, std::uint64_t steps) const override;

  private:
    ActorLearner(std::shared_ptr<ActorNet> network, const ActorTraining& training, const MotionSpec& spec,
                 const LearnerSetup& setup);

    at::Tensor noise(std::uint64_t step) const;

    ActorTraining training_;
    std::uint64_t first_sample_;  ///< of this process among those of a step
    RandomFeed feed_;
    std::optional<RestJoints> joints_;
    std::shared_ptr<ActorNet> net_;
};

}  // namespace actformer::model
