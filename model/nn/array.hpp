// A named array of numbers outside of any tensor library.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace actformer::model {

struct Array {
    std::string name;
    std::vector<std::int64_t> shape;
    std::variant<std::vector<float>, std::vector<double>> values;  ///< row-major, as exact as they were
};

}  // namespace actformer::model
