// Long lists in messages of one line.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace actformer {

/// "a, b, c, ...": the first three names, and dots where there are more.
inline std::string first_few(const std::vector<std::string>& names) {
    constexpr std::ptrdiff_t shown = 3;
    const bool more = std::ssize(names) > shown;
    return fmt::format("{}{}", fmt::join(names.begin(), more ? names.begin() + shown : names.end(), ", "),
                       more ? ", ..." : "");
}

}  // namespace actformer
