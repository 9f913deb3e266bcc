#include "eval/scoring/labels_file.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>

#include "base/error.hpp"

namespace actformer::eval {
namespace {

std::optional<std::uint32_t> label_of(const std::string& action, const std::vector<std::string>& classes) {
    const auto named = std::find(classes.begin(), classes.end(), action);
    if (named != classes.end()) return static_cast<std::uint32_t>(named - classes.begin());
    const char *begin = action.data(), *end = begin + action.size();
    if (begin != end && *begin == 'A') ++begin;
    std::uint32_t number = 0;
    const auto [rest, error] = std::from_chars(begin, end, number);
    if (error != std::errc() || rest != end || number == 0 || number > classes.size()) return {};
    return number - 1;
}

}  // namespace

std::map<std::string, std::uint32_t> read_labels_file(const std::filesystem::path& path,
                                                      const std::vector<std::string>& classes) {
    std::ifstream file(path);
    if (!file) throw Error("{}: cannot be read", path.string());
    constexpr const char* blanks = " \t\r";
    std::map<std::string, std::uint32_t> out;
    std::size_t number = 0;
    for (std::string line; std::getline(file, line);) {
        ++number;
        line.erase(line.find_last_not_of(blanks) + 1);
        line.erase(0, line.find_first_not_of(blanks));
        if (line.empty() || line[0] == '#') continue;
        const auto gap = line.find_first_of(blanks);
        if (gap == std::string::npos)
            throw Error("{}: line {}: names no action beside '{}'", path.string(), number, line);
        const auto action = line.substr(line.find_first_not_of(blanks, gap));
        const auto label = label_of(action, classes);
        if (!label)
            throw Error("{}: line {}: '{}' is none of the {} classes, by name or from 1 on", path.string(),
                        number, action, classes.size());
        if (!out.try_emplace(line.substr(0, gap), *label).second)
            throw Error("{}: line {}: '{}' comes twice", path.string(), number, line.substr(0, gap));
    }
    if (out.empty()) throw Error("{}: holds no labels", path.string());
    return out;
}

}  // namespace actformer::eval
