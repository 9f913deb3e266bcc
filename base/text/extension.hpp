// The ends of files' names.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>

#include "base/text/lower_case.hpp"

namespace actformer {

/// Whether a path ends in `extension`, as in ".pkl", in any case of ASCII letters.
inline bool ends_in_extension(std::string_view path, std::string_view extension) {
    return path.size() >= extension.size() &&
           std::equal(extension.begin(), extension.end(), path.end() - std::ssize(extension),
                      [&](char a, char b) { return lower_case(a) == lower_case(b); });
}

}  // namespace actformer
