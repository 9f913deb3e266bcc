// What a generator's training may be told whatever its method.
#pragma once

#include <cstdint>
#include <string>

#include "model/train/trainer_settings.hpp"

namespace actformer::model {

struct GeneratorTrainerSettings : TrainerSettings {
    GeneratorTrainerSettings() {
        epochs = 500;
        rate_factor = 0.25;
    }
    std::string recogniser;                                 ///< empty: nothing is scored
    std::uint32_t score_every = 10, score_per_class = 100;  ///< epochs; motions
};

std::vector<Key> generator_keys();

GeneratorTrainerSettings generator_trainer_settings(const Config& config);

/// Throws Error, beginning with `where`, where the configuration's `persons` or `classes` are others than the motions'.
void check_subjects(const Config& config, std::uint32_t persons, std::size_t classes,
                    const std::string& where);

}  // namespace actformer::model
