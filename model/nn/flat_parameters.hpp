// A network's parameters laid end to end in one piece of memory, and their gradients in another: a step of the optimiser,
// a mean over processes or over time is one pass. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <vector>

namespace actformer::model {

class FlatParameters {
  public:
    /// Moves float32 `parameters`, leaves that want gradients, into memory of its own; they stay the tensors they were.
    /// `appended` more values lie behind the gradients, such as losses, so that one all-reduce averages both.
    explicit FlatParameters(std::vector<at::Tensor> parameters, std::int64_t appended = 0);

    at::Tensor& values() { return values_; }  ///< (count); parameters begin at whole vectors, zeros between
    at::Tensor& gradients() { return gradients_; }                  ///< (count)
    at::Tensor& appended_values() { return appended_values_; }      ///< (appended)
    at::Tensor& all_reduce_buffer() { return all_reduce_buffer_; }  ///< (count + appended)

    /// Before a backward pass, which adds to the gradients.
    void zero_gradients();

    /// Moves the values towards `latest`, whose EMA of this decay a step they are, behind `steps` steps: the beginning is soon forgotten.
    void follow(const FlatParameters& latest, double decay, std::uint64_t steps);

    /// Whether a backward pass reaches these parameters.
    void want_gradients(bool wanted);

  private:
    std::vector<at::Tensor> parameters_;
    at::Tensor values_, all_reduce_buffer_, gradients_, appended_values_;
};

}  // namespace actformer::model
