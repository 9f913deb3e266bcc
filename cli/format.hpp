// Numbers as people read them.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace actformer::cli {

/// "3.2 GB", in powers of 1000.
inline std::string bytes(std::uint64_t value) {
    const auto v = static_cast<double>(value);
    if (v >= 1e9) return fmt::format("{:.2f} GB", v / 1e9);
    if (v >= 1e6) return fmt::format("{:.1f} MB", v / 1e6);
    if (v >= 1e3) return fmt::format("{:.1f} kB", v / 1e3);
    return fmt::format("{} bytes", value);
}

}  // namespace actformer::cli
