// The OpenCL sources of kernels/cl, embedded at build.
#pragma once

#include <string_view>

namespace actformer::kernels {

/// Text of kernels/cl/NAME.cl; empty where there is no such file.
std::string_view source(std::string_view name);

}  // namespace actformer::kernels
