// Where joints are and how far they lie apart, as differentiable functions of rotations on processors. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <memory>

#include "model/cpu/forward_kinematics.hpp"

namespace actformer::model {

/// rotations (N, P*6, T, K), float or double, on the CPU -> the joints' positions from the root (N, P*3, T, K - 1).
at::Tensor fused_joint_positions(const std::shared_ptr<const cpu::RestSkeleton>& skeleton,
                                 const at::Tensor& rotations);

/// made, real (N, P*6, T, K), float or double, on the CPU -> the mean squared difference of all joints' positions, from the root;
/// no gradient to `real`.
at::Tensor fused_joint_error(const cpu::RestSkeleton& skeleton, const at::Tensor& made,
                             const at::Tensor& real);

}  // namespace actformer::model
