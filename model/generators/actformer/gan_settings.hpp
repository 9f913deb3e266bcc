// What a generator's configuration may say of its training (DESIGN 4.7); of the networks, see network_keys().
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/nn/adam_settings.hpp"
#include "model/train/config.hpp"

namespace actformer::model {

enum class Loss {
    wasserstein,  ///< D: mean D(made) - mean D(real); G: - mean D(made) (the paper's equation 1)
    hinge         ///< D: mean max(0, 1 - D(real)) + mean max(0, 1 + D(made)); G the same
};

/// Every key, of the networks and of the training, with the paper's values.
Config generator_config();

struct GanSettings {
    std::string data, train_split;
    std::uint32_t frames = 60, batch = 64, epochs = 500;  ///< batch: windows a D step, of each process
    std::uint32_t discriminator_steps = 4;                ///< a generator's step
    Loss loss = Loss::hinge;
    AdamSettings generator, discriminator;
    std::vector<std::int64_t> rate_drops;  ///< epochs at whose start both rates are multiplied by rate_factor
    double rate_factor = 1;
    double average = 0;  ///< decay a step of the mean of the generator's weights; 0 keeps none
    std::string recogniser;
    std::uint32_t score_every = 0, score_per_class = 0;  ///< epochs; motions generated
    double checkpoint_minutes = 0;
    std::uint64_t seed = 0;
    std::string device, opencl;
    bool bf16 = false;
    int threads = 0;  ///< 0: as many as the process may use
};

GanSettings gan_settings(const Config& config);

/// Keys that may change when a training goes on: where it runs, how long, and how it is watched.
const std::vector<std::string>& generator_keys_free_to_change();

}  // namespace actformer::model
