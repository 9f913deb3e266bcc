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

/// The array called `name`. Throws Error that begins with `where` where there is none.
const Array& array_named(const std::vector<Array>& arrays, const std::string& name, const std::string& where);

}  // namespace actformer::model
