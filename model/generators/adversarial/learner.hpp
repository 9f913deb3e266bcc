// A GAN in the training loop. Includes torch headers.
#pragma once

#include "model/generators/adversarial/gan.hpp"
#include "model/generators/method.hpp"
#include "model/train/learner.hpp"
#include "model/train/window_feed.hpp"

namespace actformer::model {

/// A step is one of the generator's behind `discriminator_steps` of the discriminator's, each with windows of its own.
class GanLearner : public Learner {
  public:
    /// `config` holds gan_keys() and generator_keys(); networks for motions of `spec`, on the setup's device.
    GanLearner(const Config& config, const MotionSpec& spec, GanNetworks networks, const LearnerSetup& setup);

    std::uint64_t windows_a_step() const override;
    void step(std::uint64_t step, double rate_share) override;
    at::Tensor& sums() override { return gan_.sums(); }
    Measures losses(const std::vector<double>& sums, std::uint64_t steps) const override;
    std::string trouble(const Measures& losses) const override;
    bool finite() override { return gan_.finite(); }
    std::vector<Array> state() override { return gan_.state(); }
    void load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) override {
        gan_.load(state, steps, where);
    }
    void broadcast(std::uint64_t steps) override { gan_.broadcast(steps); }
    std::vector<Array> weights() override;
    bool keeps_ema() const override { return settings_.average > 0; }
    std::vector<Array> ema_weights() override;

    /// A discriminator step and a generator step, all on the same windows.
    std::vector<Phase> phases() override;

  private:
    GanSettings settings_;
    std::int64_t channels_, nodes_;  ///< of motions
    std::uint32_t batch_;
    at::Device device_;
    RandomFeed feed_;
    Gan gan_;
    at::Tensor ema_labels_;  ///< (N) int64, of the motions by which the EMA's buffers are found
};

}  // namespace actformer::model
