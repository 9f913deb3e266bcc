// Parts of names such as "P01G02", a letter and a number.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace actformer {

/// The number behind `letter` at the front of `text`, which both are taken from; none where they are not there.
template <typename Number>
std::optional<Number> take_number(std::string_view& text, char letter) {
    if (!text.starts_with(letter)) return {};
    Number number = 0;
    const auto [end, fault] = std::from_chars(text.data() + 1, text.data() + text.size(), number);
    if (fault != std::errc()) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

}  // namespace actformer
