// What the training loop trains. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kernels/sampler.hpp"
#include "model/nn/array.hpp"
#include "model/train/processes.hpp"
#include "model/train/training_events.hpp"

namespace actformer::model {

/// What a learner is given. All of it outlives the learner.
struct LearnerSetup {
    const kernels::ClipStore& clips;  ///< the split to train on
    at::Device device;
    const Processes& processes;
};

/// A part of a step that runs on its own, any number of times, for a benchmark to time.
struct Phase {
    std::string name;                               ///< as in "generator step"
    std::function<void(std::uint64_t number)> run;  ///< its random numbers are those of `number`
};

class Learner {
  public:
    virtual ~Learner() = default;

    /// Windows that a step takes, of each process.
    virtual std::uint64_t windows_a_step() const = 0;

    /// Step `step`, from 0, with its learning rates times `rate_share`. Every random number is a function of the seed and of
    /// the step's number.
    virtual void step(std::uint64_t step, double rate_share) = 0;

    /// Sums of the losses over steps, (n) double on the device, to which every step adds. Reading them waits for the device. The loop sets them to 0.
    virtual at::Tensor& sums() = 0;

    /// What `sums` over the last `steps` steps come to.
    virtual Measures losses(const std::vector<double>& sums, std::uint64_t steps) const = 0;

    /// What is wrong with such losses, in words; empty where nothing is. NaN and infinite losses need not be looked for.
    virtual std::string trouble(const Measures& losses) const;

    /// Whether every weight is finite.
    virtual bool finite() = 0;

    /// All that the next step depends on, its number apart.
    virtual std::vector<Array> state() = 0;

    /// Takes it back, behind `steps` steps. Throws Error, beginning with `where`, for arrays that are missing or of another
    /// shape.
    virtual void load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) = 0;

    /// Gives every process the state of rank 0, behind `steps` steps.
    virtual void broadcast(std::uint64_t steps) = 0;

    /// What is saved: the weights of the last step, and their EMA where one is kept.
    virtual std::vector<Array> weights() = 0;
    virtual bool keeps_ema() const { return false; }
    virtual std::vector<Array> ema_weights();

    /// The parts of a step, one of each kind; none where a step is one piece. Running them moves the weights as no training would.
    /// Good while the learner lives and step() is not called.
    virtual std::vector<Phase> phases();
};

}  // namespace actformer::model
