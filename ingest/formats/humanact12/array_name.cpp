#include "ingest/formats/humanact12/array_name.hpp"

#include <charconv>

namespace actformer::ingest {
namespace {

constexpr std::uint32_t class_count = 12;

/// The number behind `letter` at the front of `text`, which it is taken from; none where there is none.
std::optional<std::uint32_t> take_number(std::string_view& text, char letter) {
    if (!text.starts_with(letter)) return {};
    std::uint32_t number = 0;
    const auto [end, fault] = std::from_chars(text.data() + 1, text.data() + text.size(), number);
    if (fault != std::errc()) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

}  // namespace

std::vector<std::string> array_fields() {
    return {"subject", "group", "repetition", "first", "last", "action", "fine"};
}

std::optional<ArrayName> parse_array_name(std::string_view stem) {
    ArrayName name;
    for (const char letter : {'P', 'G', 'R', 'F', 'T'}) {
        const auto number = take_number(stem, letter);
        if (!number) return {};
        name.fields.push_back(std::to_string(*number));
    }
    constexpr std::size_t spelt = 5;
    const bool four_digits = stem.size() == spelt;
    const auto both = take_number(stem, 'A');
    if (!both || !four_digits || !stem.empty()) return {};
    const auto coarse = *both / 100;
    if (coarse < 1 || coarse > class_count) return {};
    name.label = coarse - 1;
    name.fields.push_back(std::to_string(coarse));
    name.fields.push_back(std::to_string(*both));
    return name;
}

}  // namespace actformer::ingest
