// Seeds of a training's parts and steps.
#pragma once

#include <cstdint>

namespace actformer::model {

/// A well-mixed number for what is random in step `step`.
std::uint64_t step_seed(std::uint64_t seed, std::uint64_t step);

/// What step_seed() takes for a step where a generator's training draws for these parts; its generator's weights take the training's seed
/// itself. Scoring may share augmentation's number: it draws latents by what comes out, while augmentation mixes that with its own steps.
constexpr std::uint64_t latents_part = 0, discriminator_part = 1, augmentation_part = 2, scoring_part = 2;

}  // namespace actformer::model
