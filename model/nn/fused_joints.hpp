// How far joints lie apart, as a differentiable function of rotations on processors. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include "model/cpu/turned_joints.hpp"

namespace actformer::model {

/// made, real (N, P*6, T, K), float or double, on the CPU -> the mean squared difference of all joints' positions, from the root;
/// no gradient to `real`.
at::Tensor fused_joint_error(const cpu::RestSkeleton& skeleton, const at::Tensor& made,
                             const at::Tensor& real);

}  // namespace actformer::model
