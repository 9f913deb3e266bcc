// Whether stored weights are those of a network, by its list of weights, before the network takes memory. Knows nothing of torch.
#pragma once

#include <string>
#include <vector>

#include "model/nn/array.hpp"
#include "model/nn/network.hpp"

namespace actformer::model {

/// Throws Error, beginning with `where`, unless every weight of the network is among the arrays and of its shape.
void check_weights_fit(const std::vector<NetworkWeight>& network, const std::vector<Array>& arrays,
                       const std::string& where);

}  // namespace actformer::model
