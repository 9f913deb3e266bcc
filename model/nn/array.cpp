#include "model/nn/array.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace actformer::model {

const Array& array_named(const std::vector<Array>& arrays, const std::string& name,
                         const std::string& where) {
    const auto found = std::ranges::find(arrays, name, &Array::name);
    if (found == arrays.end())
        throw Error("{}: holds no '{}': damaged, or of another configuration", where, name);
    return *found;
}

const Array& array_named(const std::vector<Array>& arrays, const std::string& name,
                         const std::vector<std::int64_t>& shape, const std::string& where) {
    const auto& array = array_named(arrays, name, where);
    if (array.shape != shape)
        throw Error(
            "{}: '{}' is of shape ({}) where its configuration wants ({}): damaged, or of another "
            "configuration",
            where, name, fmt::join(array.shape, ", "), fmt::join(shape, ", "));
    return array;
}

}  // namespace actformer::model
