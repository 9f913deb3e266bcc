// ACTOR's losses (Petrovich et al., ICCV 2021, section 3.4), as means as in the public code. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include "model/generators/actor/network.hpp"
#include "model/generators/rest_joints.hpp"

namespace actformer::model {

struct ActorLosses {
    at::Tensor total, rc, rcxyz, kl;  ///< kl: the sum over the batch; rcxyz undefined where there is none
};

/// Between real and made motions, (N, P*D, T, K) both: `rc` the mean squared difference of all numbers, `rcxyz` that of the joints'
/// positions, of all persons together.
ActorLosses actor_losses(const at::Tensor& real, const at::Tensor& made, const ActorNet::Latent& latent,
                         double kl_factor, const RestJoints* joints);

}  // namespace actformer::model
