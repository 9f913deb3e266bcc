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

/// Text that standard error does not take is lost, and nothing ends: there is no place left to say so.
inline void write_to_stderr(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
}

/// fmt::print on standard output with every text shown. Throws std::system_error where that cannot be written.
template <typename... Values>
void say(fmt::format_string<decltype(shown(std::declval<const Values&>()))...> text,
         const Values&... values) {
    fmt::print(text, shown(values)...);
}

/// The same on standard error, beside the results.
template <typename... Values>
void remark(fmt::format_string<decltype(shown(std::declval<const Values&>()))...> text,
            const Values&... values) {
    write_to_stderr(fmt::format(text, shown(values)...));
}

}  // namespace actformer::cli
