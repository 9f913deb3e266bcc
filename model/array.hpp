// A named array of numbers outside of any tensor library.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace actformer::model {

struct Array {
    std::string name;
    std::vector<std::int64_t> shape;
    std::vector<float> values;  ///< row-major
};

}  // namespace actformer::model
