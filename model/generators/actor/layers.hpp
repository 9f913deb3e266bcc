// ACTOR described without tensors: its weights in order, under the names of the public state_dict, and its layers. Knows nothing of torch.
#pragma once

#include <string>
#include <vector>

#include "model/generators/actor/settings.hpp"
#include "model/nn/network.hpp"

namespace actformer::model {

/// Encoder, then decoder. Tables start normal, attention's first maps Xavier uniform over all three, their biases at 0, all else as
/// torch.nn.Linear does; the layers of a stack start alike, as copies of the first.
std::vector<NetworkWeight> actor_weights(const ActorSettings& settings);

/// What a layer's weights are called behind.
std::string encoder_layer(std::uint32_t layer);
std::string decoder_layer(std::uint32_t layer);

/// Lines for `actformer model`; shapes are of one motion of `frames` frames.
std::vector<NetworkSummary> actor_summary(const ActorSettings& settings, std::uint32_t frames);

}  // namespace actformer::model
