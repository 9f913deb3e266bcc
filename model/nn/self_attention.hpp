// Self-attention in libtorch's operators. Includes torch headers.
#pragma once

#include "model/nn/fused.hpp"

namespace actformer::model {

/// Multi-head self-attention of x (N, T, W) -> (N, T, W): proj(softmax(q k^T / sqrt(W / heads)) v). `qkv` maps to queries, keys and
/// values side by side, (3W, W), each of `heads` heads of W / heads numbers; `proj` is (W, W). Differentiable, on any device.
at::Tensor self_attention(const at::Tensor& x, const LinearTensors& qkv, const LinearTensors& proj,
                          std::int64_t heads);

}  // namespace actformer::model
