// GRU cells over frames on processors as differentiable functions of tensors (model/cpu/gru_kernel.hpp). Includes torch headers.
//
// Tensors are float or double, on the CPU; states multiples of 16 wide. Without gradients (at::NoGradGuard) nothing is kept for the way
// back.
#pragma once

#include <ATen/ATen.h>

#include "model/cpu/chain_kernel.hpp"
#include "model/nn/fused.hpp"

namespace actformer::model {

/// Gates in the order r, z, n: weights (3*hidden, hidden), biases (3*hidden). The first cell's `input` is not looked at.
struct GruTensors {
    LinearTensors input, hidden;
};

/// What the first cell's gates are given, without what is fed back: products (T, N, 3*hidden), of_sample (N, 3*hidden), of_frame
/// (T, 3*hidden).
struct GruInputs {
    at::Tensor products, of_sample, of_frame;
};

/// States (T, N, hidden) of the last of one or two cells.
at::Tensor fused_gru(const GruInputs& inputs, const std::vector<GruTensors>& cells);

/// A pose's rotations in place of its positions: see cpu::ChainBody. bones (T, N, joints).
struct ChainBodyTensors {
    LinearTensors weight;
    const cpu::Chains* chains = nullptr;  ///< none: poses are positions. They must outlive the backward pass
    at::Tensor bones;
    bool feeds_joints = false;
};

struct FusedPoses {
    at::Tensor out, joints;  ///< (T, N, numbers); joints only of rotations along chains
};

/// Poses out of the second cell's states, each fed back: in frame t the first cell's gates get weight (3*hidden, numbers) times the pose
/// of frame t - 1.
FusedPoses fused_fed_back_poses(const GruInputs& inputs, const std::vector<GruTensors>& cells,
                                const at::Tensor& weight, const LinearTensors& head,
                                const ChainBodyTensors& body);

/// What a learnt prior is made of: its cell, what its gates are given (no products), get of the last pose, `pose` (3*hidden, numbers), and
/// what becomes of its state: head (2*latent, hidden), means, then logarithms of variances. latent (3*hidden, latent) is what the
/// decoder's gates get of what is drawn.
struct PriorTensors {
    GruInputs inputs;
    GruTensors cell;
    at::Tensor pose;
    LinearTensors head;
    at::Tensor latent;
};

/// The same as fused_fed_back_poses with latents that the prior draws frame by frame; noise (T, N, latent). Not differentiable.
FusedPoses fused_sampled_poses(const PriorTensors& prior, const GruInputs& inputs,
                               const std::vector<GruTensors>& cells, const at::Tensor& weight,
                               const LinearTensors& head, const ChainBodyTensors& body,
                               const at::Tensor& noise);

/// poses (M, 3J), bones (M, J) -> joints (M, 3J), as cpu::chain_kinematics. No gradient to the bones.
at::Tensor fused_chain_kinematics(const cpu::Chains& chains, const at::Tensor& poses,
                                  const at::Tensor& bones);

}  // namespace actformer::model
