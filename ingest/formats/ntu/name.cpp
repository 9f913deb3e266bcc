#include "ingest/formats/ntu/name.hpp"

#include <vector>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/lines.hpp"

namespace actformer::ingest {
namespace {

constexpr std::string_view letters = "SCPRA";
constexpr std::size_t name_length = 20;

}  // namespace

std::optional<NtuName> parse_ntu_name(std::string_view stem) {
    if (stem.size() != name_length) return {};
    int numbers[5] = {};
    for (std::size_t i = 0; i < letters.size(); ++i) {
        if (stem[4 * i] != letters[i]) return {};
        for (std::size_t d = 1; d <= 3; ++d) {
            const char c = stem[4 * i + d];
            if (c < '0' || c > '9') return {};
            numbers[i] = numbers[i] * 10 + (c - '0');
        }
    }
    if (numbers[4] < 1 || numbers[4] > 120) return {};
    return NtuName{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]};
}

std::vector<std::string> ntu_fields() {
    return {"setup", "camera", "performer", "replication", "action"};
}

std::vector<std::string> ntu_fields_of(const NtuName& name) {
    std::vector<std::string> values;
    for (const int value : {name.setup, name.camera, name.performer, name.replication, name.action})
        values.push_back(std::to_string(value));
    return values;
}

std::unordered_set<std::string> read_missing_list(const std::filesystem::path& path) {
    std::vector<char> scratch;
    auto text = without_bom(read_text(path, scratch, std::uint64_t{64} << 20));
    std::unordered_set<std::string> names;
    while (!text.empty()) {
        const auto line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
        const auto first = skip_blanks(line.data(), line.data() + line.size());
        const std::string_view name(first,
                                    std::min<std::size_t>(name_length, line.data() + line.size() - first));
        if (parse_ntu_name(name)) names.emplace(name);
    }
    if (names.empty())
        throw Error("{}: no clip names in this missing list; one SsssCcccPpppRrrrAaaa a line", path.string());
    return names;
}

}  // namespace actformer::ingest
