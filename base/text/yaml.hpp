// YAML that people write: configurations, sweeps and skeletons.
#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "base/text/printable.hpp"

namespace actformer {

/// Bytes of such a file. A larger one was given by mistake.
inline constexpr std::uint64_t largest_yaml = std::uint64_t{16} << 20;

struct BadKey {
    int line;  ///< from 1
    std::string what;
};

/// The first key of a map that is no text or is given twice: of two values one reader would take the first and another the last.
inline std::optional<BadKey> bad_key(const YAML::Node& map) {
    std::set<std::string> seen;
    for (const auto& item : map) {
        const auto& key = item.first;
        const int line = key.Mark().line + 1;
        if (!key.IsScalar()) return BadKey{line, "a key must be a text"};
        if (!seen.insert(key.Scalar()).second)
            return BadKey{line, fmt::format("{} is given twice", in_quotes(key.Scalar()))};
    }
    return std::nullopt;
}

}  // namespace actformer
