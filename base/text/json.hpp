// JSON that may come from anywhere: lists and objects within one another are bounded, as copying and printing them takes stack, and
// whole numbers are read as they are, where the library cuts off what a type cannot hold.
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace actformer {

constexpr std::size_t deepest_json = 64;

/// The line, from 1, in which lists and objects are more than deepest_json deep; none where they never are.
std::optional<std::size_t> line_too_deep(std::string_view json);

/// Throws Error, naming `file` and the line, where lists and objects are too deep.
void expect_shallow_json(std::string_view json, const std::filesystem::path& file);

/// The value; discarded where the text is no JSON or too deep.
template <typename Json>
Json json_or_discarded(std::string_view text) {
    if (line_too_deep(text)) return Json(nlohmann::detail::value_t::discarded);
    return Json::parse(text, nullptr, false);
}

/// Throws Json::type_error where it is no whole number, or none that a T holds.
template <std::integral T, typename Json>
T whole_number(const Json& json) {
    if (json.is_number_unsigned()) {
        if (const auto number = json.template get<std::uint64_t>(); std::in_range<T>(number))
            return static_cast<T>(number);
    } else if (json.is_number_integer()) {
        if (const auto number = json.template get<std::int64_t>(); std::in_range<T>(number))
            return static_cast<T>(number);
    }
    throw Json::type_error::create(302, "a whole number is wanted that is not too large", &json);
}

/// Throws Json::type_error where any number within is none from 0 to 2^64 - 1.
template <typename Json>
void expect_counts(const Json& json) {
    if (json.is_number()) whole_number<std::uint64_t>(json);
    if (json.is_structured())
        for (const auto& within : json) expect_counts(within);
}

}  // namespace actformer
