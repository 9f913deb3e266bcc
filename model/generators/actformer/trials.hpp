// Scoring a generator on the way: its motions are made at once, and judged while training goes on. Includes torch headers.
#pragma once

#include <cstdint>
#include <future>
#include <optional>
#include <vector>

#include "model/generators/actformer/gan_settings.hpp"
#include "model/generators/actformer/motion_maker.hpp"
#include "model/nn/array.hpp"
#include "model/train/judge.hpp"

namespace actformer::model {

/// What came of a trial, and the weights that it is of.
struct Trial {
    std::uint64_t epoch = 0, step = 0;
    std::vector<Array> weights;
    JudgeScores scores;
};

class Trials {
  public:
    /// As `settings` say; `clips` are the training's split of `dataset`, and no motions are asked of classes without one.
    /// Throws Error where the recogniser does not fit the dataset.
    Trials(const GanSettings& settings, const ingest::Dataset& dataset, const kernels::ClipStore& clips);

    const Judge& judge() const { return judge_; }

    /// One at a time: none may be on its way.
    void begin(Generator& generator, std::uint64_t epoch, std::uint64_t step);

    /// Waits for the one on its way. Nothing where there is none.
    std::optional<Trial> end();

  private:
    Labelled motions_of(Generator& generator) const;

    std::uint64_t seed_;
    std::uint32_t frames_, per_class_;
    std::vector<std::uint32_t> classes_;  ///< that have clips
    Judge judge_;
    Trial trial_;
    std::future<JudgeScores> scores_;  ///< of it; last, so that it is waited for before the judge goes
};

}  // namespace actformer::model
