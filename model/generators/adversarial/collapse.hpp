// Signs that a generator and its discriminator no longer learn from each other.
#pragma once

#include <string>

#include "model/generators/adversarial/gan_settings.hpp"

namespace actformer::model {

/// Means over some steps.
struct GanLosses {
    double discriminator = 0, real_score = 0, fake_score = 0, generator = 0;
};

/// What is wrong with them, in words; empty where nothing is.
std::string collapse_in(const GanLosses& losses, Loss loss);

}  // namespace actformer::model
