// A recogniser in the training loop, and its scores on a test split. Includes torch headers.
#pragma once

#include "eval/metrics/confusion.hpp"
#include "model/recognisers/network.hpp"
#include "model/train/augmentation.hpp"
#include "model/train/validator.hpp"
#include "model/train/window_feed.hpp"

namespace actformer::model {

class RecogniserLearner : public Learner {
  public:
    RecogniserLearner(const RecogniserSettings& settings, std::unique_ptr<RecogniserNetwork> network,
                      std::size_t classes, Augmentation augmentation, const LearnerSetup& setup);

    std::uint64_t windows_a_step() const override { return settings_.batch; }
    void step(std::uint64_t step, double rate_share) override;
    at::Tensor& sums() override { return sums_; }
    Measures losses(const std::vector<double>& sums, std::uint64_t steps) const override;
    bool finite() override { return network_->finite(); }
    std::vector<Array> state() override { return network_->state(); }
    void load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) override {
        network_->load(state, steps, where);
    }
    void broadcast(std::uint64_t /*steps*/) override {}  // by one process
    std::vector<Array> weights() override { return network_->weights(); }

    /// What it takes every window of `clips` for.
    eval::Confusion confusion_on(const kernels::ClipStore& clips) const;

  private:
    at::Tensor values_of(const Windows& windows) const;
    at::Tensor noisy(const at::Tensor& motion, std::uint64_t seed) const;

    RecogniserSettings settings_;
    at::Device device_;
    const kernels::ClipTable& table_;
    std::size_t classes_;
    std::unique_ptr<RecogniserNetwork> network_;
    RandomFeed feed_;
    Augmentation augmentation_;  ///< of the windows to learn from
    double rate_ = 0;            ///< of the last step
    at::Tensor sums_;            ///< [loss, windows recognised]
};

class TestSplitValidator : public Validator {
  public:
    /// Scores `learner`, the one that is trained, on `clips`; both outlive the validator.
    TestSplitValidator(std::string split, const kernels::ClipStore& clips, RecogniserLearner& learner)
        : split_(std::move(split)), clips_(clips), learner_(learner) {}

    bool due(std::uint64_t /*epoch*/, bool /*last*/) const override { return true; }
    void begin(std::uint64_t epoch, std::uint64_t step) override;
    std::optional<Validation> end() override { return std::exchange(validation_, std::nullopt); }
    bool in_background() const override { return false; }
    std::string fingerprint() const override { return split_; }

    const std::optional<eval::Confusion>& confusion() const { return confusion_; }  ///< of the last scores

  private:
    std::string split_;
    const kernels::ClipStore& clips_;
    RecogniserLearner& learner_;
    std::optional<Validation> validation_;
    std::optional<eval::Confusion> confusion_;
};

}  // namespace actformer::model
