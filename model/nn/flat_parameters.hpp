// A network's parameters laid end to end in one piece of memory, and their gradients in another: a step of the optimiser,
// a mean over processes or over time is one pass. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <vector>

namespace actformer::model {

class FlatParameters {
  public:
    /// Moves float32 `parameters`, leaves that want gradients, into memory of its own; they stay the tensors they were.
    /// `remarks` numbers more lie behind the gradients, so that what is averaged over processes takes one message.
    explicit FlatParameters(std::vector<at::Tensor> parameters, std::int64_t remarks = 0);

    at::Tensor& values() { return values_; }  ///< (count); parameters begin at whole vectors, zeros between
    at::Tensor& gradients() { return gradients_; }  ///< (count)
    at::Tensor& remarks() { return remarks_; }      ///< (remarks)
    at::Tensor& message() { return message_; }      ///< (count + remarks)

    /// Before a backward pass, which adds to the gradients.
    void zero_gradients();

    /// Moves the values towards `latest`, whose EMA of this decay a step they are, behind `steps` steps: the beginning is soon forgotten.
    void follow(const FlatParameters& latest, double decay, std::uint64_t steps);

    /// Whether a backward pass reaches these parameters.
    void want_gradients(bool wanted);

  private:
    std::vector<at::Tensor> parameters_;
    at::Tensor values_, message_, gradients_, remarks_;
};

}  // namespace actformer::model
