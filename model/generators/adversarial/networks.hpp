// A GAN's two networks as its training and its maker know them. Includes torch headers.
#pragma once

#include <torch/nn/module.h>

#include <memory>

#include "model/generators/adversarial/gan_settings.hpp"
#include "model/generators/adversarial/prior.hpp"
#include "model/train/step_seed.hpp"

namespace actformer::model {

class GanGenerator : public torch::nn::Module {
  public:
    /// What its latents are.
    virtual const PriorSettings& prior() const = 0;

    /// Frames of the latents of motions of `frames` frames.
    virtual std::int64_t latent_frames(std::int64_t frames) const { return frames; }

    /// latent (N, streams, latent_frames(frames), channels) of Prior::draw, labels (N) int64 -> motions (N, P*D, frames, K),
    /// person by person.
    virtual at::Tensor generate(const at::Tensor& latent, const at::Tensor& labels, std::int64_t frames) = 0;

    /// Estimates anew the buffers that depend on the weights, once these have become an EMA's and the buffers are still the trained
    /// network's: singular vectors of spectral norms by power iteration, statistics of batch normalisation from motions of `frames`
    /// frames that it generates from `prior`, one for each of `labels` (N) int64.
    virtual void recompute_buffers(const Prior& prior, const at::Tensor& labels, std::int64_t frames) = 0;
};

class GanDiscriminator : public torch::nn::Module {
  public:
    /// motion (N, P*D, T, K), labels (N) int64 -> scores (N), the higher the more real.
    virtual at::Tensor forward(const at::Tensor& motion, const at::Tensor& labels) = 0;
};

struct GanNetworks {
    std::shared_ptr<GanGenerator> generator;
    std::shared_ptr<GanGenerator> ema;  ///< like the generator; null where no EMA is kept
    std::shared_ptr<GanDiscriminator> discriminator;
};

/// Networks of these settings on `device`, their weights as the training's seed has them.
template <typename Generator, typename Discriminator, typename GeneratorSettings,
          typename DiscriminatorSettings>
GanNetworks gan_networks(const GanSettings& settings, const GeneratorSettings& of_generator,
                         const DiscriminatorSettings& of_discriminator, const at::Device& device) {
    const auto on_device = [&](auto network) {
        network->to(device);
        return network;
    };
    GanNetworks networks;
    networks.generator = on_device(std::make_shared<Generator>(of_generator, settings.seed));
    if (settings.average > 0)
        networks.ema = on_device(std::make_shared<Generator>(of_generator, settings.seed));
    networks.discriminator = on_device(
        std::make_shared<Discriminator>(of_discriminator, step_seed(settings.seed, discriminator_part)));
    return networks;
}

}  // namespace actformer::model
