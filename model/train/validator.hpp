// Scoring on the way: what the training loop asks at the end of an epoch. Includes torch headers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/nn/array.hpp"
#include "model/train/learner.hpp"

namespace actformer::model {

struct Scores {
    ScoreReport report;          ///< all but whether it is the best
    double merit = 0;            ///< the larger, the better
    std::vector<Array> weights;  ///< that were scored
};

class Scorer {
  public:
    virtual ~Scorer() = default;

    /// Whether to score at the end of `epoch`, counted from 1; `last` is the training's.
    virtual bool due(std::uint64_t epoch, bool last) const = 0;

    /// Begins to score the weights of the learner that it was made for. None may be on its way.
    virtual void begin(std::uint64_t epoch, std::uint64_t step) = 0;

    /// Waits for the scores on their way; none where there are none.
    virtual std::optional<Scores> end() = 0;

    /// Whether scores go on while training does: they then get a line of log.jsonl of their own, else they are in their
    /// epoch's.
    virtual bool in_background() const = 0;

    /// Names what scores depend on beside the weights: those of another scorer are not compared.
    virtual std::string fingerprint() const = 0;
};

}  // namespace actformer::model
