// Joints out of rotations along chains of bones, and in and out of a representation. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include "model/generators/action2motion/chains.hpp"
#include "model/generators/action2motion/settings.hpp"

namespace actformer::model::action2motion {

/// poses (N, 3J): the root's position, then one axis times angle a joint; bones (N, J) lengths -> joints (N, 3J). Every chain
/// begins with R = I; along it R = R exp(w_j), p_j = p_before + R (length_j direction_j).
at::Tensor chain_kinematics(const Chains& chains, const at::Tensor& poses, const at::Tensor& bones);

/// joints (N, 3J) -> (N, J), 0 for the root.
at::Tensor bone_lengths(const Chains& chains, const at::Tensor& joints);

/// Poses (..., 3J) of limbs, parent + length * limb, as joints' positions, and back: limbs divided by (their length + 1e-4).
at::Tensor joints_of_limbs(const ingest::Topology& tree, const std::vector<float>& lengths,
                           const at::Tensor& poses);
at::Tensor limbs_of_joints(const ingest::Topology& tree, const at::Tensor& joints);

}  // namespace actformer::model::action2motion
