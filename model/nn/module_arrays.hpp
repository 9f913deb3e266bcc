// A libtorch module's parameters and buffers as arrays, and back. Includes torch headers.
#pragma once

#include <torch/nn/module.h>

#include <string>
#include <vector>

#include "model/nn/array.hpp"

namespace actformer::model {

/// Every parameter and buffer, under `prefix` and its name.
std::vector<Array> arrays_of(const torch::nn::Module& module, const std::string& prefix);

/// Throws Error that begins with `where` for what is missing or of another shape.
void load_arrays(const torch::nn::Module& module, const std::string& prefix, const std::vector<Array>& arrays,
                 const std::string& where);

/// Adds `tensors` as state.0, state.1, ...: what belongs to a training, but to no module.
void add_state(std::vector<Array>& arrays, const std::vector<at::Tensor>& tensors);

/// Fills `tensors` with state.0, state.1, ... Throws Error that begins with `where` for what is missing or of
/// another size.
void load_state(const std::vector<at::Tensor>& tensors, const std::vector<Array>& arrays,
                const std::string& where);

}  // namespace actformer::model
