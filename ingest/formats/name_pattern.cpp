#include "ingest/formats/name_pattern.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

[[noreturn]] void refuse(std::string_view pattern, std::string_view why) {
    throw Error(
        "name pattern {}: {}; write it as in 'dataset-2_{{action}}_{{style}}_{{index}}', with {{*}} for what "
        "does "
        "not matter",
        in_quotes(pattern), why);
}

std::string_view without_extension(std::string_view text) {
    constexpr std::string_view extension = ".bvh";
    if (text.size() < extension.size()) return text;
    const auto end = text.substr(text.size() - extension.size());
    const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + ('a' - 'A') : a) == b; };
    return std::equal(end.begin(), end.end(), extension.begin(), same)
               ? text.substr(0, text.size() - end.size())
               : text;
}

bool is_field_name(std::string_view name) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-';
    };
    return !name.empty() && std::all_of(name.begin(), name.end(), fits);
}

}  // namespace

NamePattern::NamePattern(std::string_view text) : text_(without_extension(text)) {
    std::string literal;
    for (std::size_t i = 0; i < text_.size(); ++i) {
        if (text_[i] == '}') refuse(text_, "a } without its {");
        if (text_[i] != '{') {
            literal += text_[i];
            continue;
        }
        const auto close = text_.find('}', i);
        if (close == std::string::npos) refuse(text_, "a { without its }");
        if (literal.empty() && !parts_.empty()) refuse(text_, "two fields with nothing between them");
        const auto name = std::string_view(text_).substr(i + 1, close - i - 1);
        parts_.push_back({literal, name == "*"});
        if (name != "*") add_field(name);
        literal.clear();
        i = close;
    }
    tail_ = literal;
    const auto action = std::find(fields_.begin(), fields_.end(), "action");
    if (action == fields_.end()) refuse(text_, "it has no {action}");
    action_ = static_cast<std::size_t>(action - fields_.begin());
}

void NamePattern::add_field(std::string_view name) {
    if (!is_field_name(name))
        refuse(text_, fmt::format("{} is no field name of letters, digits, - and _", in_quotes(name)));
    // What a dataset stores of every clip under these names.
    for (const auto taken : {"name", "label", "offset", "length", "bone_length"})
        if (name == taken) refuse(text_, fmt::format("a field may not be called '{}'", name));
    if (std::find(fields_.begin(), fields_.end(), name) != fields_.end())
        refuse(text_, fmt::format("two fields called '{}'", name));
    fields_.emplace_back(name);
}

std::optional<std::vector<std::string>> NamePattern::match(std::string_view stem) const {
    const std::string_view first = parts_.front().before;
    if (stem.size() < first.size() + tail_.size() || stem.substr(0, first.size()) != first) return {};
    if (stem.substr(stem.size() - tail_.size()) != tail_) return {};
    stem = stem.substr(first.size(), stem.size() - first.size() - tail_.size());

    // Ending every field as soon as may be leaves most to the fields after it: no other cut can fit where
    // this does not.
    std::vector<std::string> values;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (stem.empty()) return {};
        std::size_t end = stem.size(), next = stem.size();
        if (i + 1 < parts_.size()) {
            const std::string& separator = parts_[i + 1].before;
            end = stem.find(separator, 1);
            if (end == std::string_view::npos) return {};
            next = end + separator.size();
        }
        if (!parts_[i].forgotten) values.push_back(printable(stem.substr(0, end)));
        stem = stem.substr(next);
    }
    return values;
}

}  // namespace actformer::ingest
