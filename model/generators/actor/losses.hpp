// ACTOR's losses (Petrovich et al., ICCV 2021, section 3.4), as means as in the public code. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <vector>

#include "model/cpu/turned_joints.hpp"
#include "model/generators/actor/network.hpp"

namespace actformer::model {

/// Joints of a rest skeleton, turned.
class RestJoints {
  public:
    /// `rest` (joints, 3) as ingest::BodyModel has it. Throws Error, beginning with `where`, where it is missing.
    RestJoints(const ingest::Topology& topology, const std::vector<float>& rest, const std::string& where);

    /// rotations (M, joints, 6) below each joint's parent, first two rows, of any length -> positions (M, joints, 3) from the root.
    at::Tensor positions(const at::Tensor& rotations) const;

    /// The mean squared difference between the positions of two motions' joints, (N, P*6, T, K) both, all persons together. On the CPU
    /// by a kernel of our own.
    at::Tensor error(const at::Tensor& made, const at::Tensor& real) const;

  private:
    at::Tensor positions_of_all(const at::Tensor& motion) const;

    /// Joints as far from the root as each other.
    struct Level {
        at::Tensor joints, parents;  ///< (n) int64; parents are counted within the level before
        at::Tensor offsets;          ///< (n, 3, 1) from the parent
    };
    std::vector<Level> levels_;
    at::Tensor place_;  ///< (joints) of a joint among all levels'
    cpu::RestSkeleton skeleton_;
};

struct ActorLosses {
    at::Tensor total, rc, rcxyz, kl;  ///< kl: the sum over the batch; rcxyz undefined where there is none
};

/// Between real and made motions, (N, P*D, T, K) both: `rc` the mean squared difference of all numbers, `rcxyz` that of the joints'
/// positions, of all persons together.
ActorLosses actor_losses(const at::Tensor& real, const at::Tensor& made, const ActorNet::Latent& latent,
                         double kl_factor, const RestJoints* joints);

}  // namespace actformer::model
