// What is printed for people: text from outside (names of files, of clips, of classes) is shown with what a terminal would obey escaped.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <type_traits>

#include "base/text/printable.hpp"

namespace actformer::cli {

/// Text printable, other values as they are.
template <typename Value>
decltype(auto) shown(const Value& value) {
    if constexpr (std::is_convertible_v<const Value&, std::string_view>)
        return printable(value);
    else
        return value;
}

/// fmt::print with every text shown.
template <typename... Values>
void say(std::FILE* to, fmt::format_string<decltype(shown(std::declval<const Values&>()))...> text,
         const Values&... values) {
    fmt::print(to, text, shown(values)...);
}
template <typename... Values>
void say(fmt::format_string<decltype(shown(std::declval<const Values&>()))...> text,
         const Values&... values) {
    fmt::print(text, shown(values)...);
}

}  // namespace actformer::cli
