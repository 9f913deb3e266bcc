// Where a rest skeleton's joints are once they are turned. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <memory>
#include <string>
#include <vector>

#include "ingest/dataset/topology.hpp"
#include "model/cpu/forward_kinematics.hpp"
#include "model/nn/constant.hpp"

namespace actformer::model {

/// Joints of a rest skeleton, turned.
class RestJoints {
  public:
    /// `rest` (joints, 3) as ingest::BodyModel has it. Throws Error, beginning with `where`, where it is missing; `without`, as in
    /// "d_joints=0", is how the user does without joints.
    RestJoints(const ingest::Topology& topology, const std::vector<float>& rest, const std::string& where,
               const std::string& without);

    /// rotations (M, joints, 6) below each joint's parent, first two rows, of any length -> positions (M, joints, 3) from the root.
    at::Tensor positions(const at::Tensor& rotations) const;

    /// motion (N, P*6, T, K) of rotations -> positions (N, P*3, T, K - 1) of all persons' joints, each from its root. On the CPU by a kernel
    /// of our own.
    at::Tensor positions_in(const at::Tensor& motion) const;

    /// The mean squared difference between the positions of two motions' joints, (N, P*6, T, K) both, all persons together. On the CPU
    /// by a kernel of our own.
    at::Tensor error(const at::Tensor& made, const at::Tensor& real) const;

  private:
    /// Joints as far from the root as each other.
    struct Level {
        Constant joints, parents;  ///< (n) int64; parents are counted within the level before
        Constant offsets;          ///< (n, 3, 1) from the parent
    };
    std::vector<Level> levels_;
    Constant place_;  ///< (joints) of a joint among all levels'
    std::shared_ptr<const cpu::RestSkeleton> skeleton_;
};

}  // namespace actformer::model
