// Whether a training has diverged, by the mean losses of some steps at a time.
#pragma once

#include <cstdint>
#include <string>

#include "model/train/learner.hpp"

namespace actformer::model {

class DivergenceWatch {
  public:
    /// Takes the losses of the last `steps` steps, and what the learner finds wrong with them.
    void see(const Measures& losses, const std::string& trouble, std::uint64_t steps);

    /// Nothing is wrong: a checkpoint of now is worth keeping.
    bool sound() const { return trouble_.empty(); }

    /// Why the training has diverged; empty while it has not. NaN or infinite losses count at once, any other trouble
    /// after `patience` steps of it.
    std::string verdict() const;

    static constexpr std::uint64_t patience = 200;

  private:
    std::string trouble_;
    std::uint64_t steps_ = 0;  ///< in trouble
    bool at_once_ = false;
};

}  // namespace actformer::model
