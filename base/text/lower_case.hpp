// Letters of names in one case.
#pragma once

#include <string>
#include <string_view>

namespace actformer {

/// Of ASCII; any other character stays.
constexpr char lower_case(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

inline std::string lower_case(std::string_view text) {
    std::string out(text);
    for (auto& c : out) c = lower_case(c);
    return out;
}

}  // namespace actformer
