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

/// The array called `name`. Throws Error that begins with `where` where there is none.
const Array& array_named(const std::vector<Array>& arrays, const std::string& name, const std::string& where);

/// The same, which must be of `shape`: Error otherwise.
const Array& array_named(const std::vector<Array>& arrays, const std::string& name,
                         const std::vector<std::int64_t>& shape, const std::string& where);

}  // namespace actformer::model
