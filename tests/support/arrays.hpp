// NumPy arrays for tests, byte by byte.
#pragma once

#include <string>

namespace actformer::test {

inline std::string npy_with_header(const std::string& header, const std::string& values, int version = 1) {
    std::string out = "\x93NUMPY";
    out += static_cast<char>(version);
    out += '\0';
    for (int b = 0; b < (version == 1 ? 2 : 4); ++b) out += static_cast<char>(header.size() >> (8 * b) & 255);
    return out + header + values;
}

/// `type` as in "<f4", `shape` as in "(2, 3)".
inline std::string npy(const std::string& type, const std::string& shape, const std::string& values,
                       bool fortran = false, int version = 1) {
    return npy_with_header("{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") +
                               ", 'shape': " + shape + ", }          \n",
                           values, version);
}

}  // namespace actformer::test
