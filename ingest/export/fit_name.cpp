#include "ingest/export/fit_name.hpp"

#include <fmt/format.h>

#include <unordered_map>
#include <unordered_set>

#include "base/text/printable.hpp"
#include "base/text/utf8.hpp"

namespace actformer::ingest {
namespace {

/// The character that `text` begins with, or its first byte where that is none.
std::string_view first_of(std::string_view text) {
    const auto character = first_character(text);
    return text.substr(0, character ? character->bytes : 1);
}

bool is_allowed(std::string_view character, NameFor use) {
    const auto c = static_cast<unsigned char>(character[0]);
    if (c >= 0x80) return use != NameFor::bvh && printable(character) == character;
    if (c < 0x20 || c == 0x7F) return false;
    if (use == NameFor::bvh) return c != ' ' && c != '{' && c != '}';
    constexpr std::string_view reserved = "/\\:*?\"<>|";
    return use == NameFor::text || reserved.find(character[0]) == std::string_view::npos;
}

/// The most bytes that leave room for an ending in a file's name, cut where a character ends.
std::string cut(std::string name) {
    constexpr std::size_t longest = 200;
    if (name.size() <= longest) return name;
    std::size_t end = 0;
    for (auto next = end; next <= longest; next += first_of(std::string_view(name).substr(next)).size())
        end = next;
    return name.substr(0, end);
}

}  // namespace

std::string fit_name(std::string_view name, NameFor use) {
    std::string out;
    while (!name.empty()) {
        const auto c = first_of(name);
        out += is_allowed(c, use) ? std::string(c) : "_";
        name.remove_prefix(c.size());
    }
    if (out.empty()) return "_";
    if (use != NameFor::file) return out;
    if (out[0] == '.') out[0] = '_';  // neither hidden nor a way up
    return cut(out);
}

std::vector<std::string> fit_names(const std::vector<std::string>& names, NameFor use) {
    std::vector<std::string> out;
    std::unordered_set<std::string> taken;
    std::unordered_map<std::string, std::size_t> next;  // numbers below it are taken
    for (const auto& name : names) {
        const auto fit = fit_name(name, use);
        auto one = fit;
        auto& number = next.try_emplace(fit, std::size_t{2}).first->second;
        for (; !taken.insert(one).second; ++number) one = fmt::format("{}_{}", fit, number);
        out.push_back(one);
    }
    return out;
}

std::string names_changed(const std::vector<std::string>& before, const std::vector<std::string>& after,
                          std::string_view what) {
    std::size_t changed = 0, first = 0;
    for (std::size_t i = before.size(); i-- > 0;)
        if (before[i] != after[i]) {
            ++changed;
            first = i;
        }
    if (changed == 0) return {};
    return fmt::format("{} {}{} changed, as {} to {}", changed, what, changed == 1 ? " was" : "s were",
                       in_quotes(before[first]), in_quotes(after[first]));
}

}  // namespace actformer::ingest
