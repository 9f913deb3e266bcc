#include "model/generators/actor/losses.hpp"

namespace actformer::model {

ActorLosses actor_losses(const at::Tensor& real, const at::Tensor& made, const ActorNet::Latent& latent,
                         double kl_factor, const RestJoints* joints) {
    ActorLosses losses;
    losses.rc = (made - real).square().mean();
    losses.kl = -0.5 * (1 + latent.log_variance - latent.mean.square() - latent.log_variance.exp()).sum();
    losses.total = losses.rc + kl_factor * losses.kl;
    if (!joints) return losses;
    losses.rcxyz = joints->error(made, real);
    losses.total = losses.total + losses.rcxyz;
    return losses;
}

}  // namespace actformer::model
