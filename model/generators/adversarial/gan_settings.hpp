// How a generator and a discriminator train against each other. Of what the networks are made, their method says.
#pragma once

#include <cstdint>
#include <vector>

#include "model/nn/adam_settings.hpp"
#include "model/train/augmentation_settings.hpp"
#include "model/train/config.hpp"

namespace actformer::model {

enum class Loss {
    wasserstein,  ///< D: mean D(fake) - mean D(real); G: - mean D(fake) (equation 1 of ActFormer)
    hinge         ///< D: mean max(0, 1 - D(real)) + mean max(0, 1 + D(fake)); G: - mean D(fake)
};

struct GanSettings : AugmentationSettings {
    std::uint32_t frames = 60;
    std::uint64_t seed = 0;
    std::uint32_t discriminator_steps = 4;  ///< a generator's step
    Loss loss = Loss::hinge;
    double generator_rate = 2e-4, discriminator_rate = 2e-4;
    double beta1 = 0, beta2 = 0.999;  ///< of Adam
    double spread =
        0;  ///< weight of the loss that keeps motions of a class as far apart as real ones; 0: none
    double average = 0;                     ///< decay a step of the generator's EMA; 0 keeps none
    bool bf16 = false, cuda_graphs = true;  ///< on CUDA

    AdamSettings generator_adam() const { return {generator_rate, beta1, beta2}; }
    AdamSettings discriminator_adam() const { return {discriminator_rate, beta1, beta2}; }
};

std::vector<Key> gan_keys();

/// Of a configuration that holds gan_keys(), `frames`, `seed` and `device`.
GanSettings gan_settings(const Config& config);

}  // namespace actformer::model
