#include "ingest/formats/name_pattern.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text/extension.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

[[noreturn]] void refuse(std::string_view pattern, std::string_view why) {
    throw Error(
        "name pattern {}: {}; write it as in 'dataset-2_{{action}}_{{style}}_{{index}}' or "
        "'{{action}}/{{index}}', with {{*}} for "
        "what does not matter",
        in_quotes(pattern), why);
}

bool is_field_name(std::string_view name) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-';
    };
    return !name.empty() && std::all_of(name.begin(), name.end(), fits);
}

/// Why `name` cannot be a field's; empty where it can.
std::string fault_of_field_name(std::string_view name) {
    if (!is_field_name(name))
        return fmt::format("{} is no field name of letters, digits, - and _", in_quotes(name));
    // What a dataset stores of every clip under these names.
    for (const auto taken : {"name", "label", "offset", "length", "bone_length"})
        if (name == taken) return fmt::format("a field may not be called '{}'", name);
    return {};
}

std::vector<std::string_view> split_at_slashes(std::string_view path) {
    std::vector<std::string_view> out;
    for (;;) {
        const auto slash = path.find('/');
        out.push_back(path.substr(0, slash));
        if (slash == std::string_view::npos) return out;
        path.remove_prefix(slash + 1);
    }
}

}  // namespace

std::string_view without_extension(std::string_view path) {
    for (const std::string_view extension :
         {".bvh", ".amc", ".asf", ".skeleton", ".npy", ".npz", ".csv", ".tsv", ".h5", ".hdf5", ".pkl"})
        if (ends_in_extension(path, extension)) return path.substr(0, path.size() - extension.size());
    return path;
}

void check_field_name(const std::string& where, std::string_view name) {
    if (const auto fault = fault_of_field_name(name); !fault.empty()) throw Error("{}: {}", where, fault);
}

NamePattern::NamePattern(std::string_view text, bool needs_action) : text_(without_extension(text)) {
    for (const auto component : split_at_slashes(text_)) components_.push_back(read_component(component));
    const auto action = std::find(fields_.begin(), fields_.end(), "action");
    if (action == fields_.end() && needs_action) refuse(text_, "it has no {action}");
    action_ = static_cast<std::size_t>(action - fields_.begin());
}

NamePattern::Component NamePattern::read_component(std::string_view text) {
    Component out;
    std::string literal;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '}') refuse(text_, "a } without its {");
        if (text[i] != '{') {
            literal += text[i];
            continue;
        }
        const auto close = text.find('}', i);
        if (close == std::string::npos) refuse(text_, "a { without its }");
        if (literal.empty() && !out.parts.empty()) refuse(text_, "two fields with nothing between them");
        const auto name = text.substr(i + 1, close - i - 1);
        out.parts.push_back({literal, name == "*"});
        if (name != "*") add_field(name);
        literal.clear();
        i = close;
    }
    out.tail = literal;
    if (out.parts.empty() && out.tail.empty())
        refuse(text_, text_.empty() ? "it is empty" : "nothing before or after a /");
    return out;
}

void NamePattern::add_field(std::string_view name) {
    if (const auto fault = fault_of_field_name(name); !fault.empty()) refuse(text_, fault);
    if (std::find(fields_.begin(), fields_.end(), name) != fields_.end())
        refuse(text_, fmt::format("two fields called '{}'", name));
    fields_.emplace_back(name);
}

bool NamePattern::match(const Component& component, std::string_view name, std::vector<std::string>& values) {
    const auto& [parts, tail] = component;
    if (parts.empty()) return name == tail;
    const std::string_view first = parts.front().before;
    if (name.size() < first.size() + tail.size() || !name.starts_with(first) || !name.ends_with(tail))
        return false;
    name = name.substr(first.size(), name.size() - first.size() - tail.size());

    // Ending every field as soon as may be leaves most to the fields after it: no other cut can fit where
    // this does not.
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (name.empty()) return false;
        std::size_t end = name.size(), next = name.size();
        if (i + 1 < parts.size()) {
            const std::string& separator = parts[i + 1].before;
            end = name.find(separator, 1);
            if (end == std::string_view::npos) return false;
            next = end + separator.size();
        }
        if (!parts[i].forgotten) values.push_back(printable(name.substr(0, end)));
        name = name.substr(next);
    }
    return true;
}

std::optional<std::vector<std::string>> NamePattern::match(std::string_view path) const {
    const auto names = split_at_slashes(path);
    if (names.size() < components_.size()) return {};
    std::vector<std::string> values;
    for (std::size_t i = 0; i < components_.size(); ++i)
        if (!match(components_[i], names[names.size() - components_.size() + i], values)) return {};
    return values;
}

}  // namespace actformer::ingest
