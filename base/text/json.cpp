#include "base/text/json.hpp"

#include "base/error.hpp"

namespace actformer {

std::optional<std::size_t> line_too_deep(std::string_view json) {
    std::size_t depth = 0, line = 1;
    bool text = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        line += c == '\n';
        if (c == '"') text = !text;
        if (text && c == '\\') ++i;
        if (text) continue;
        if (c == '[' || c == '{') ++depth;
        if ((c == ']' || c == '}') && depth > 0) --depth;
        if (depth > deepest_json) return line;
    }
    return {};
}

void expect_shallow_json(std::string_view json, const std::filesystem::path& file) {
    if (const auto line = line_too_deep(json))
        throw Error("{}: line {}: lists and objects more than {} deep; is it the right file?", file.string(),
                    *line, deepest_json);
}

}  // namespace actformer
