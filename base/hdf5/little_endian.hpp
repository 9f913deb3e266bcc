// Numbers in the bytes of a file.
#pragma once

#include <cstring>
#include <string_view>

namespace actformer::hdf5 {

/// A little-endian number at `at`, which must lie within.
template <typename T>
T number_in(std::string_view bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

}  // namespace actformer::hdf5
