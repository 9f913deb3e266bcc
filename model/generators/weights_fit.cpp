#include "model/generators/weights_fit.hpp"

namespace actformer::model {

void check_weights_fit(const std::vector<NetworkWeight>& network, const std::vector<Array>& arrays,
                       const std::string& where) {
    for (const auto& weight : network) array_named(arrays, weight.name, weight.shape, where);
}

}  // namespace actformer::model
