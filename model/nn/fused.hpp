// ActFormer's layers on processors as differentiable functions of tensors. Includes torch headers.
//
// Tensors are contiguous, float or double, on the CPU. Without gradients (at::NoGradGuard) nothing is kept for the backward pass.
#pragma once

#include <ATen/ATen.h>

#include <memory>

#include "ingest/dataset/representation.hpp"
#include "model/cpu/node_kernels.hpp"

namespace actformer::model {

struct LinearTensors {
    at::Tensor weight, bias;
};

/// The weight (rows in its first axes) over its largest singular value. With `iterate` u and v are moved first.
at::Tensor fused_spectral(const at::Tensor& weight, const at::Tensor& u, const at::Tensor& v, bool iterate);

/// latent (N, S, T, channels), classes (N, W), positions (T+1, P, W) -> tokens (N, P, T+1, W); no gradient to the latent.
at::Tensor fused_embedding(const at::Tensor& latent, const LinearTensors& linear, const at::Tensor& classes,
                           const at::Tensor& positions);

/// x (N, P, T+1, W) plus the attention over persons, or over tokens, of its norm.
at::Tensor fused_attention(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& qkv,
                           const LinearTensors& proj, std::int64_t heads, bool over_persons);

/// x (N, P, T+1, W) plus the MLP of its norm.
at::Tensor fused_mlp(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& up,
                     const LinearTensors& down);

/// The same, x itself becoming the result. Not differentiable.
void fused_attention_in_place(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& qkv,
                              const LinearTensors& proj, std::int64_t heads, bool over_persons);
void fused_mlp_in_place(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& up,
                        const LinearTensors& down);

/// x (N, P, T+1, W) -> motions (N, P*D, T, K) in a representation: norm, linear map, finish.
at::Tensor fused_poses(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& head,
                       ingest::Representation representation);

/// motion (N, C, T, K) -> (N, K, padding + T + padding, 2C), the numbers and their differences over time.
at::Tensor fused_motion_input(const at::Tensor& motion, std::int64_t padding);

/// A graph convolution and its LeakyReLU. x (N, in_nodes, padded_frames, in), bias (out_nodes, out) or undefined ->
/// (N, out_nodes, padded_out_frames, out).
at::Tensor fused_node_convolution(const at::Tensor& x, const at::Tensor& weight, const at::Tensor& bias,
                                  const cpu::NodeShape& shape, std::shared_ptr<const cpu::NodeSums> sums,
                                  double leak);

}  // namespace actformer::model
