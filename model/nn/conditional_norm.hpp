// Conditional batch normalisation and its LeakyReLU as a differentiable function of tensors. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <cstdint>

namespace actformer::model {

struct ConditionalNormTensors {
    at::Tensor gain, shift;        ///< (N, C): a row a sample, as its class has it
    at::Tensor mean, variance;     ///< (C): running statistics, moved while training
    double momentum = 0.1;         ///< of the running statistics; the variance among them is unbiased
    double leak = 0.2;             ///< by which negative numbers are multiplied
    std::int64_t padding = 0;      ///< frames on either side of x, passed over
    std::int64_t out_padding = 0;  ///< zeros on either side of the result's frames
};

/// x (N, nodes, padding + F + padding, C) -> (N, nodes, out_padding + F + out_padding, C), every channel normalised over
/// samples, nodes and frames: by the batch's statistics while `training`, else by the running ones and, where `fused`, not
/// differentiable. `fused` takes kernels of our own, on processors; else libtorch's operators.
at::Tensor conditional_norm(const at::Tensor& x, const ConditionalNormTensors& norm, bool training,
                            bool fused);

}  // namespace actformer::model
