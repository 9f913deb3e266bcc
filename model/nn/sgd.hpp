// Stochastic gradient descent with momentum, as PyTorch's SGD does it. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <vector>

namespace actformer::model {

struct SgdSettings {
    double momentum = 0.9, weight_decay = 1e-4;
    bool nesterov = true;
};

class Sgd {
  public:
    /// `parameters` share memory with the network's.
    Sgd(std::vector<at::Tensor> parameters, const SgdSettings& settings);

    /// Takes the gradients, moves the parameters, and forgets the gradients.
    void step(double rate);

    std::vector<at::Tensor>& momenta() { return momenta_; }

  private:
    std::vector<at::Tensor> parameters_, momenta_;
    SgdSettings settings_;
};

}  // namespace actformer::model
