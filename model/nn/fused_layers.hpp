// The recogniser's layers on processors as differentiable functions of tensors. Includes torch headers.
//
// Tensors are contiguous (N, T, K, C), float or double, on the CPU; hidden channels are multiples of 16.
#pragma once

#include <ATen/ATen.h>

#include "model/cpu/layer_kernels.hpp"

namespace actformer::model {

/// x (N,T,K,in), strength (E), weight (3*in, out), bias (K, out) -> (N,T,K,out). `edges` (E, 3) int32: part, source, target.
at::Tensor fused_graph_convolution(const at::Tensor& x, const at::Tensor& strength, const at::Tensor& weight,
                                   const at::Tensor& bias, const at::Tensor& edges);

/// x (N,T,K,in), weight (taps, in, out), bias (out) -> (N, ceil(T/stride), K, out), zeros beyond the first and last frame.
at::Tensor fused_temporal_convolution(const at::Tensor& x, const at::Tensor& weight, const at::Tensor& bias,
                                      std::int64_t stride);

/// What a batch normalisation keeps, (C) each. The running two are moved while training.
struct NormWeights {
    at::Tensor weight, bias, running_mean, running_variance;
};

/// relu(dropout(normalised x) + shortcut), as `options` says; an undefined shortcut adds nothing. Differentiable while
/// training, by the statistics of the batch; else by the running ones and not differentiable.
at::Tensor fused_norm(const at::Tensor& x, const NormWeights& weights, const cpu::NormOptions& options,
                      const at::Tensor& shortcut, bool training);

}  // namespace actformer::model
