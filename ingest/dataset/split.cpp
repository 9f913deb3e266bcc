#include "ingest/dataset/split.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text/first_few.hpp"
#include "base/text/printable.hpp"
#include "base/text/suggestion.hpp"

namespace actformer::ingest {
namespace {

std::vector<std::string> pieces(const std::string& text, char separator) {
    std::vector<std::string> out;
    for (std::size_t from = 0; from <= text.size();) {
        const auto to = std::min(text.find(separator, from), text.size());
        out.push_back(text.substr(from, to - from));
        from = to + 1;
    }
    return out;
}

[[noreturn]] void refuse_field(const Split& split, const Condition& condition,
                               const std::vector<std::string>& fields) {
    throw Error("split {}: clips have no field '{}'; they have {}{}", split.name, condition.field,
                fmt::join(fields, ", "), suggestion(condition.field, fields));
}

/// Why no clip is in `split`.
std::string why_empty(const Split& split, const std::vector<std::string>& fields,
                      const std::set<std::vector<std::string>>& clips) {
    for (const auto& condition : split.conditions) {
        const Split alone{split.name, {condition}};
        const auto holds = [&](const auto& clip) { return alone.holds(fields, clip); };
        if (std::any_of(clips.begin(), clips.end(), holds)) continue;
        const auto field = std::find(fields.begin(), fields.end(), condition.field) - fields.begin();
        std::set<std::string> there;
        for (const auto& clip : clips) there.insert(printable(clip[static_cast<std::size_t>(field)]));
        const auto values = first_few({there.begin(), there.end()});
        return condition.negated
                   ? fmt::format("all have {} {}", condition.field, values)
                   : fmt::format("none has {} {}; there {} {}", condition.field,
                                 printable(fmt::format("{}", fmt::join(condition.values, " or "))),
                                 there.size() == 1 ? "is" : "are", values);
    }
    return "none meets all its conditions";
}

}  // namespace

bool Split::holds(const std::vector<std::string>& fields, const std::vector<std::string>& values) const {
    return std::all_of(conditions.begin(), conditions.end(), [&](const Condition& condition) {
        const auto field = std::find(fields.begin(), fields.end(), condition.field);
        if (field == fields.end()) refuse_field(*this, condition, fields);
        const auto& value = values.at(static_cast<std::size_t>(field - fields.begin()));
        const bool named =
            std::find(condition.values.begin(), condition.values.end(), value) != condition.values.end();
        return named != condition.negated;
    });
}

Split parse_split(const std::string& given) {
    const auto text = printable(given);
    const auto refuse = [&]() -> Error {
        return Error(
            "split '{}' is not of the form NAME=FIELD:VALUE,VALUE;FIELD!:VALUE, as in "
            "xstyle/train=style:active,normal",
            text);
    };
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) throw refuse();
    Split split{text.substr(0, equals), {}};
    for (const auto& part : pieces(text.substr(equals + 1), ';')) {
        const auto colon = part.find(':');
        if (colon == std::string::npos || colon + 1 == part.size()) throw refuse();
        Condition condition{part.substr(0, colon), pieces(part.substr(colon + 1), ','), false};
        if (condition.field.ends_with('!')) {
            condition.negated = true;
            condition.field.pop_back();
        }
        if (condition.field.empty()) throw refuse();
        split.conditions.push_back(std::move(condition));
    }
    return split;
}

std::vector<Split> parse_splits(const std::vector<std::string>& texts) {
    std::vector<Split> splits;
    std::set<std::string> names{"all"};
    for (const auto& text : texts) {
        auto& split = splits.emplace_back(parse_split(text));
        if (!names.insert(split.name).second)
            throw Error("split '{}': {}; give it another name", printable(text),
                        split.name == "all" ? "all is what every clip is in"
                                            : "there is one called " + split.name + " before it");
    }
    return splits;
}

void check_fields(const std::vector<Split>& splits, const std::vector<std::string>& fields) {
    for (const auto& split : splits)
        for (const auto& condition : split.conditions)
            if (std::find(fields.begin(), fields.end(), condition.field) == fields.end())
                refuse_field(split, condition, fields);
}

std::vector<std::string> empty_splits(const std::vector<Split>& splits,
                                      const std::vector<std::string>& fields,
                                      const std::set<std::vector<std::string>>& clips) {
    std::vector<std::string> lines;
    for (const auto& split : splits)
        if (std::none_of(clips.begin(), clips.end(),
                         [&](const auto& clip) { return split.holds(fields, clip); }))
            lines.push_back(fmt::format("split {} has no clip: {}", printable(split.name),
                                        why_empty(split, fields, clips)));
    return lines;
}

std::string to_text(const std::vector<Split>& splits) {
    std::string text;
    for (const auto& split : splits) {
        text += fmt::format(" [{}", split.name);
        for (const auto& c : split.conditions)
            text += fmt::format(" {}{}:{}", c.field, c.negated ? "!" : "", fmt::join(c.values, ","));
        text += "]";
    }
    return text;
}

}  // namespace actformer::ingest
