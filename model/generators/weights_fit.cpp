#include "model/generators/weights_fit.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace actformer::model {

void check_weights_fit(const std::vector<NetworkWeight>& network, const std::vector<Array>& arrays,
                       const std::string& where) {
    for (const auto& weight : network) {
        const auto found = std::ranges::find(arrays, weight.name, &Array::name);
        if (found == arrays.end())
            throw Error("{}: holds no '{}': damaged, or of another configuration", where, weight.name);
        if (found->shape != weight.shape)
            throw Error(
                "{}: '{}' is of shape ({}) where its configuration wants ({}): damaged, or of another "
                "configuration",
                where, weight.name, fmt::join(found->shape, ", "), fmt::join(weight.shape, ", "));
    }
}

}  // namespace actformer::model
