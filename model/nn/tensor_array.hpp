// Arrays of tensors, and back. Includes torch headers: for model/'s own sources and tests only.
#pragma once

#include <ATen/core/Tensor.h>

#include <string>

#include "model/nn/array.hpp"

namespace actformer::model {

/// A tensor's numbers: as float64 where that is its type, else as float32.
Array array_of(std::string name, const at::Tensor& tensor);

/// Copies an array into a tensor of as many numbers. Throws Error, beginning with `where`, for other counts.
void copy_into(const at::Tensor& tensor, const Array& array, const std::string& where);

}  // namespace actformer::model
