// Numbers as people read them.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace actformer::cli {

/// 1234567 -> "1,234,567"
inline std::string grouped(std::uint64_t value) {
    auto digits = std::to_string(value);
    for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3) digits.insert(at, ",");
    return digits;
}

/// "3.2 GB", in powers of 1000.
inline std::string bytes(std::uint64_t value) {
    const auto v = static_cast<double>(value);
    if (v >= 1e9) return fmt::format("{:.2f} GB", v / 1e9);
    if (v >= 1e6) return fmt::format("{:.1f} MB", v / 1e6);
    if (v >= 1e3) return fmt::format("{:.1f} kB", v / 1e3);
    return fmt::format("{} bytes", value);
}

/// "1 clip", "1,200 clips"
inline std::string counted(std::uint64_t n, const std::string& noun) {
    return fmt::format("{} {}{}", grouped(n), noun, n == 1 ? "" : noun.ends_with("ss") ? "es" : "s");
}

}  // namespace actformer::cli
