#include "ingest/formats/humanact12/array_name.hpp"

#include "base/text/lettered_number.hpp"

namespace actformer::ingest {
namespace {

constexpr std::uint32_t class_count = 12;

}  // namespace

std::vector<std::string> array_fields() {
    return {"subject", "group", "repetition", "first", "last", "action", "fine"};
}

std::optional<ArrayName> parse_array_name(std::string_view stem) {
    ArrayName name;
    for (const char letter : {'P', 'G', 'R', 'F', 'T'}) {
        const auto number = take_number<std::uint32_t>(stem, letter);
        if (!number) return {};
        name.fields.push_back(std::to_string(*number));
    }
    constexpr std::size_t spelt = 5;
    const bool four_digits = stem.size() == spelt;
    const auto both = take_number<std::uint32_t>(stem, 'A');
    if (!both || !four_digits || !stem.empty()) return {};
    const auto coarse = *both / 100;
    if (coarse < 1 || coarse > class_count) return {};
    name.label = coarse - 1;
    name.fields.push_back(std::to_string(coarse));
    name.fields.push_back(std::to_string(*both));
    return name;
}

}  // namespace actformer::ingest
