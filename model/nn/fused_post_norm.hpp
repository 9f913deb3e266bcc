// Sublayers of post-norm transformer blocks, on processors, as differentiable functions of tensors. Includes torch
// headers.
//
// Tensors are as in fused.hpp. x is (N, T, W): a sample's tokens are one sequence. Each gives norm(x + dropout(branch)).
#pragma once

#include "model/cpu/random_kernel.hpp"
#include "model/nn/fused.hpp"

namespace actformer::model {

struct PostNormTensors {
    LinearTensors norm;
    double epsilon;
};

/// What is dropped within the branch, and of the branch.
struct BranchDropout {
    cpu::Dropout within, branch;
};

/// The branch is proj(attention(qkv(x))); `within` is of the softmax's weights, rows of queries by head and key.
at::Tensor fused_attention_norm(const at::Tensor& x, const LinearTensors& qkv, const LinearTensors& proj,
                                const PostNormTensors& post, std::int64_t heads,
                                const BranchDropout& dropout);

/// The branch is down(dropout(gelu(up(x)))).
at::Tensor fused_mlp_norm(const at::Tensor& x, const LinearTensors& up, const LinearTensors& down,
                          const PostNormTensors& post, const BranchDropout& dropout);

/// The branch is the sum of parts (N, P, W) and bias (W), the same for all tokens of a sample; `within` is of parts, token by token.
at::Tensor fused_sum_norm(const at::Tensor& x, const at::Tensor& parts, const at::Tensor& bias,
                          const PostNormTensors& post, const BranchDropout& dropout);

/// By what dropout multiplies the numbers of x (N, ..., columns): 0, or its scale. On the processor.
at::Tensor kept_numbers(const at::Tensor& x, const cpu::Dropout& dropout);

}  // namespace actformer::model
