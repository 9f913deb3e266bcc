// Scores of a generator while it trains: its motions are made at once, and scored while training goes on. Includes torch
// headers.
#pragma once

#include <future>

#include "model/generators/generator_settings.hpp"
#include "model/generators/method.hpp"
#include "model/train/validation_metrics.hpp"
#include "model/train/validator.hpp"

namespace actformer::model {

class GeneratorValidator : public Validator {
  public:
    /// Scores `learner`, as the settings say; `clips` are the training's split of `dataset`, and no motions are asked of classes
    /// without one. The learner outlives the validator. Throws Error where the recogniser does not fit the dataset.
    GeneratorValidator(const Config& config, const MotionSpec& spec, const ingest::Dataset& dataset,
                       const kernels::ClipStore& clips, std::string device, Learner& learner);

    const ValidationMetrics& metrics() const { return metrics_; }

    bool due(std::uint64_t epoch, bool last) const override {
        return last || epoch % settings_.score_every == 0;
    }
    void begin(std::uint64_t epoch, std::uint64_t step) override;
    std::optional<Validation> end() override;
    bool in_background() const override { return true; }
    std::string fingerprint() const override;

  private:
    Labelled motions_of(const std::vector<Array>& weights) const;

    const Config& config_;
    MotionSpec spec_;
    GeneratorTrainerSettings settings_;
    std::string device_;  ///< of libtorch
    Learner& learner_;
    std::uint32_t frames_;
    std::vector<std::uint32_t> classes_;  ///< that have clips
    ValidationMetrics metrics_;
    Validation validation_;                 ///< of the scores on their way
    std::future<ValidationScores> scores_;  ///< last, so that it is waited for before the metrics go
};

}  // namespace actformer::model
