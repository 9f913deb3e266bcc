// Validation during a training: what the training loop asks at the end of an epoch. Includes torch headers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/nn/array.hpp"
#include "model/train/learner.hpp"

namespace actformer::model {

/// A validation that is done.
struct Validation {
    ValidationReport report;     ///< all but whether it is the best
    double selection_score = 0;  ///< the larger, the better: the best weights are those of the largest
    std::vector<Array> weights;  ///< that were scored
};

class Validator {
  public:
    virtual ~Validator() = default;

    /// Whether to score at the end of `epoch`, counted from 1; `last` is the training's.
    virtual bool due(std::uint64_t epoch, bool last) const = 0;

    /// Begins to score the weights of the learner that it was made for. None may be on its way.
    virtual void begin(std::uint64_t epoch, std::uint64_t step) = 0;

    /// Waits for the scores on their way; none where there are none.
    virtual std::optional<Validation> end() = 0;

    /// Whether scores go on while training does: they then get a line of log.jsonl of their own, else they are in their
    /// epoch's.
    virtual bool in_background() const = 0;

    /// Names what scores depend on beside the weights: those of another validator are not compared.
    virtual std::string fingerprint() const = 0;
};

}  // namespace actformer::model
