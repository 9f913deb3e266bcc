// Numbers packed for the page: little-endian, in base64.
#pragma once

#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace actformer::reports {

std::string base64(std::span<const unsigned char> bytes);

template <typename T>
std::string packed(const std::vector<T>& values) {
    static_assert(std::is_integral_v<T> && sizeof(T) == 2);
    std::vector<unsigned char> bytes;
    bytes.reserve(2 * values.size());
    for (const auto value : values) {
        const auto bits = static_cast<std::make_unsigned_t<T>>(value);
        bytes.push_back(static_cast<unsigned char>(bits & 0xFF));
        bytes.push_back(static_cast<unsigned char>(bits >> 8));
    }
    return base64(bytes);
}

}  // namespace actformer::reports
