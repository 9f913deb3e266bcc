// JSON that may come from anywhere: lists and objects within one another are bounded, as copying and printing them takes stack.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

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

}  // namespace actformer
