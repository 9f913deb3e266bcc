// libtorch's device and number type: what a configuration names, and how exact the device is. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <string>

#include "model/train/trainer_settings.hpp"

namespace actformer::model {

/// Throws Error where this libtorch cannot work on `name`, as in "cpu" or "cuda:1"; `option` is what the user names it with.
at::Device torch_device(const std::string& name, const std::string& option = "device=");

/// For the whole process, which of a GPU's kernels a training takes: float32 is 24 bits everywhere but with `tf32`, also where libtorch
/// would have it otherwise; with `deterministic` what has no kernel of that kind is an error. Processors' kernels are exact and
/// deterministic as they are. Throws Error for `tf32` on a processor.
void set_tf32_and_determinism(const TrainerSettings& settings, const at::Device& device);

/// Of a configuration's "float32" or "float64".
at::ScalarType torch_type(const std::string& precision);

}  // namespace actformer::model
