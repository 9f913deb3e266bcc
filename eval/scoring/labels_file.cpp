#include "eval/scoring/labels_file.hpp"

#include <sstream>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/printable.hpp"
#include "ingest/dataset/classes.hpp"

namespace actformer::eval {
namespace {

constexpr std::uint64_t largest_file = std::uint64_t{64} << 20;

}  // namespace

std::map<std::string, std::uint32_t> read_labels_file(const std::filesystem::path& path,
                                                      const std::vector<std::string>& classes) {
    std::vector<char> scratch;
    std::istringstream file{std::string(read_text(path, scratch, largest_file))};
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
            throw Error("{}: line {}: names no action beside {}", path.string(), number, in_quotes(line));
        const auto action = line.substr(line.find_first_not_of(blanks, gap));
        const auto label =
            ingest::label_called(action, classes, fmt::format("{}: line {}", path.string(), number));
        if (!out.try_emplace(line.substr(0, gap), label).second)
            throw Error("{}: line {}: {} comes twice", path.string(), number, in_quotes(line.substr(0, gap)));
    }
    if (out.empty()) throw Error("{}: holds no labels", path.string());
    return out;
}

}  // namespace actformer::eval
