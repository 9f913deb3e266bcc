// The checkpoints that Action2Motion's authors released.
#pragma once

#include <optional>

#include "model/generators/method.hpp"

namespace actformer::model::action2motion {

/// See Method::public_weights.
std::optional<PublicWeights> public_weights(std::vector<Array> arrays, const MotionSpec& spec);

}  // namespace actformer::model::action2motion
