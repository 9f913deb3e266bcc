// Long lists in messages of one line.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace actformer {

/// "a, b, c, ...": the first three names, and dots where there are more; for messages that say otherwise how many there are.
inline std::string first_few(const std::vector<std::string>& names) {
    constexpr std::ptrdiff_t shown = 3;
    const bool more = std::ssize(names) > shown;
    return fmt::format("{}{}", fmt::join(names.begin(), more ? names.begin() + shown : names.end(), ", "),
                       more ? ", ..." : "");
}

/// "a, b and 12 more": the first `most` names, and how many there are beyond them.
inline std::string few_and_more(const std::vector<std::string>& names, std::size_t most) {
    const auto shown = std::min(most, names.size());
    const auto end = names.begin() + static_cast<std::ptrdiff_t>(shown);
    const auto more = names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : "";
    return fmt::format("{}{}", fmt::join(names.begin(), end, ", "), more);
}

}  // namespace actformer
