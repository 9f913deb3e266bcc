// libFuzzer: the first line as a pattern of names, each other one as a path without its extension. The fields of what fits stand
// in the path one after the other, what is refused is one line.
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/text/printable.hpp"
#include "ingest/formats/name_pattern.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::fuzzing;

namespace {

/// Up to the next line's end, which is taken away with it.
std::string_view next_line(std::string_view& text) {
    const auto line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    return line;
}

void check_fields(const NamePattern& pattern, std::string_view path, const std::vector<std::string>& values) {
    demand(values.size() == pattern.fields().size());
    for (const auto& value : values) demand(!value.empty() && value.find('/') == std::string::npos);
    if (printable(path) != path) return;  // values are printable, the path's own bytes or not
    std::size_t behind = 0;
    for (const auto& value : values) {
        behind = path.find(value, behind);
        demand(behind != std::string_view::npos);
        behind += value.size();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Input input(data, size);
    auto text = input.text();
    const auto first = next_line(text);
    for (const bool needs_action : {false, true})
        try_to([&] {
            const NamePattern pattern(first, needs_action);
            demand(!needs_action || pattern.action() < pattern.fields().size());
            for (auto rest = text; !rest.empty();) {
                const auto path = without_extension(next_line(rest));
                if (const auto values = pattern.match(path)) check_fields(pattern, path, *values);
            }
        });
    return 0;
}
