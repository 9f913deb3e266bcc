#include "base/text/trimmed_lines.hpp"

#include <algorithm>

#include "base/text/lines.hpp"

namespace actformer {

std::vector<std::string_view> trimmed_lines(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    std::vector<std::string_view> lines;
    text = without_bom(text);
    while (!text.empty()) {
        auto line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
        line = line.substr(0, line.find_last_not_of(blanks) + 1);
        if (!line.empty()) lines.push_back(line);
    }
    return lines;
}

}  // namespace actformer
