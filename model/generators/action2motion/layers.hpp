// Action2Motion's networks described without tensors: their weights in order, their layers and parameter counts. Names are those of the public
// state_dicts behind `prior_net.`, `posterior_net.` and `decoder.`. Knows nothing of torch.
#pragma once

#include "model/generators/action2motion/settings.hpp"
#include "model/nn/network.hpp"

namespace actformer::model::action2motion {

/// In rows: a linear embedding without activation, GRU cells and what is made of the last one's state.
std::vector<NetworkWeight> weights_of(const Settings& settings);

std::vector<NetworkSummary> summary(const Settings& settings);

}  // namespace actformer::model::action2motion
