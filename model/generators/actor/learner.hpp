// ACTOR in the training loop. Includes torch headers.
#pragma once

#include <memory>
#include <optional>

#include "model/generators/actor/losses.hpp"
#include "model/nn/adam.hpp"
#include "model/train/learner.hpp"
#include "model/train/window_feed.hpp"

namespace actformer::model {

class ActorLearner : public Learner {
  public:
    ActorLearner(const Config& config, const MotionSpec& spec, const LearnerSetup& setup);

    std::uint64_t windows_a_step() const override { return training_.batch; }
    void step(std::uint64_t step, double rate_share) override;
    at::Tensor& sums() override { return sums_; }
    Measures losses(const std::vector<double>& sums, std::uint64_t steps) const override;
    bool finite() override;
    std::vector<Array> state() override;
    void load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) override;
    void share(std::uint64_t steps) override;
    std::vector<Array> weights() override;
    bool keeps_ema() const override { return ema_values_.has_value(); }
    std::vector<Array> ema_weights() override;

  private:
    at::Tensor noise(std::uint64_t step) const;
    std::vector<at::Tensor> optimiser_state();

    ActorSettings settings_;
    ActorTraining training_;
    LearnerSetup setup_;
    std::uint64_t first_sample_;  ///< of this process among those of a step
    RandomFeed feed_;
    std::optional<RestJoints> joints_;
    std::shared_ptr<ActorNet> net_, ema_;
    FlatParameters parameters_;
    std::optional<FlatParameters> ema_values_;  ///< where an EMA is kept
    Adam adam_;
    at::Tensor sums_;  ///< loss, rc, rcxyz, kl
};

}  // namespace actformer::model
