// YAML that people write: configurations and sweeps.
#pragma once

#include <cstdint>

namespace actformer {

/// Bytes of such a file. A larger one was given by mistake.
inline constexpr std::uint64_t largest_yaml = std::uint64_t{16} << 20;

}  // namespace actformer
