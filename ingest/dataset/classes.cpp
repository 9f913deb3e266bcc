#include "ingest/dataset/classes.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "base/error.hpp"
#include "base/text/lower_case.hpp"
#include "base/text/nearest_word.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

/// "7", "A007", "a7"
std::optional<std::uint32_t> number_in(std::string_view said) {
    if (said.starts_with('A') || said.starts_with('a')) said.remove_prefix(1);
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(said.data(), said.data() + said.size(), number);
    if (said.empty() || error != std::errc() || end != said.data() + said.size()) return {};
    return number;
}

/// As in "walking, jumping jacks", a list of two.
std::string without_blanks(const std::string& said) {
    const auto first = said.find_first_not_of(" \t"), last = said.find_last_not_of(" \t");
    return first == std::string::npos ? "" : said.substr(first, last - first + 1);
}

/// The class of that name; of several that differ in case only, the one written so.
std::optional<std::uint32_t> named(const std::string& said, const std::vector<std::string>& classes) {
    auto found = std::ranges::find(classes, said);
    if (found == classes.end())
        found = std::ranges::find(classes, lower_case(said),
                                  [](const std::string& name) { return lower_case(name); });
    if (found == classes.end()) return {};
    return static_cast<std::uint32_t>(found - classes.begin());
}

}  // namespace

std::uint32_t label_called(const std::string& said, const std::vector<std::string>& classes,
                           const std::string& where) {
    const auto trimmed = without_blanks(said);
    for (const auto& written :
         {said, trimmed, printable(trimmed)})  // the last as ingest writes names that are no UTF-8
        if (const auto label = named(written, classes)) return *label;
    const auto number = number_in(trimmed);
    if (number && *number >= 1 && (classes.empty() || *number <= classes.size())) return *number - 1;
    const auto shown = in_quotes(trimmed);
    if (classes.empty())
        throw Error("{}: there is no class {}; its classes have no names, only numbers from 1 on, as in 7",
                    where, shown);
    if (number)
        throw Error("{}: there is no class {}; they are numbered from 1 to {} ('{}' .. '{}')", where, *number,
                    classes.size(), printable(classes.front()), printable(classes.back()));
    const auto nearest = nearest_word(lower_case(trimmed), classes);
    if (!nearest.empty())
        throw Error("{}: there is no class {}; did you mean '{}'?", where, shown, printable(nearest));
    throw Error("{}: there is no class {}; give a name or a number from 1 to {} ('{}' .. '{}')", where, shown,
                classes.size(), printable(classes.front()), printable(classes.back()));
}

}  // namespace actformer::ingest
