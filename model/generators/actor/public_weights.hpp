// The checkpoints that ACTOR's authors released.
#pragma once

#include <optional>

#include "model/generators/method.hpp"

namespace actformer::model {

/// See Method::public_weights. Checkpoints do not tell their attention's heads: 4, as published, unless the user says otherwise.
std::optional<PublicWeights> actor_public_weights(std::vector<Array> arrays, const MotionSpec& spec);

}  // namespace actformer::model
