// Counts as people read them.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace actformer {

/// 1234567 -> "1,234,567"
inline std::string grouped(std::uint64_t value) {
    auto digits = std::to_string(value);
    for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3) digits.insert(at, ",");
    return digits;
}

/// "1 clip", "1,200 clips"
inline std::string counted(std::uint64_t n, const std::string& noun) {
    return fmt::format("{} {}{}", grouped(n), noun, n == 1 ? "" : noun.ends_with("ss") ? "es" : "s");
}

}  // namespace actformer
