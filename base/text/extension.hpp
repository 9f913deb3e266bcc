// The ends of files' names.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>

namespace actformer {

/// Whether a path ends in `extension`, as in ".pkl", in any case of ASCII letters.
inline bool ends_in_extension(std::string_view path, std::string_view extension) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return path.size() >= extension.size() &&
           std::equal(extension.begin(), extension.end(), path.end() - std::ssize(extension),
                      [&](char a, char b) { return lower(a) == lower(b); });
}

}  // namespace actformer
