#include "base/text/csv.hpp"

namespace actformer {

std::string csv_cell(std::string_view text) {
    std::string out;
    if (!text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos) out = "'";
    out += text;
    if (out.find_first_of(",\"\n\r") == std::string::npos) return out;
    for (auto at = out.find('"'); at != std::string::npos; at = out.find('"', at + 2)) out.insert(at, 1, '"');
    return "\"" + out + "\"";
}

}  // namespace actformer
