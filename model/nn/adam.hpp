// Adam and AdamW, as PyTorch does them, over parameters that lie end to end. Includes torch headers.
#pragma once

#include "model/nn/adam_settings.hpp"
#include "model/nn/flat_parameters.hpp"

namespace actformer::model {

class Adam {
  public:
    /// `parameters` must outlive the optimiser.
    Adam(FlatParameters& parameters, const AdamSettings& settings);

    /// Takes the gradients and moves the parameters, at `share` of the rate.
    void step(double share = 1);

    at::Tensor& means() {
        return means_;
    }  ///< of the gradients; empty where beta1 is 0: it is the gradient itself then
    at::Tensor& squares() { return squares_; }  ///< means of the squared gradients

    std::uint64_t steps = 0;  ///< taken so far

  private:
    /// What a step comes to behind `steps` of them.
    struct Scales {
        double rate, root;  ///< corrected for means that began at 0
        double keep;        ///< of every weight: 1 without weight decay
    };
    void step_here(const Scales& scales);
    void step_in_operators(const Scales& scales);

    FlatParameters* parameters_;
    AdamSettings settings_;
    at::Tensor means_, squares_, scratch_;
};

}  // namespace actformer::model
