#include "ingest/formats/bvh/bvh_options.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.hpp"
#include "base/text/number.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

/// The number that `text` begins with, and what follows it; nothing where there is none.
std::optional<std::pair<double, std::string>> number_and_rest(const std::string& text) {
    const std::string padded = text + std::string(16, '\0');
    double value = 0;
    const char* end = parse_number(padded.c_str(), value);
    if (!end) return {};
    return std::pair{value, text.substr(static_cast<std::size_t>(end - padded.c_str()))};
}

std::optional<float> read_scale(const std::string& text) {
    if (text == "auto") return {};
    const auto number = number_and_rest(text);
    if (!number || !number->second.empty() || !(number->first > 1e-6 && number->first < 1e6))
        throw Error("scale {} is not a number of metres a unit; centimetres are 0.01, and auto finds out",
                    printable(text));
    return static_cast<float>(number->first);
}

ClipPlace read_place(const char* option, const std::string& text) {
    const auto number = number_and_rest(text);
    const bool in_range = number && number->first >= 0 && number->first <= 1e9;
    const bool seconds = in_range && number->second == "s";
    const bool frames = in_range && number->second.empty() && number->first == std::floor(number->first);
    if (!seconds && !frames)
        throw Error("{} {} is no place in a clip; give frames, as in 30, or seconds, as in 1.5s", option,
                    in_quotes(text));
    return {number->first, seconds};
}

void check_rate(double fps, const char* what) {
    if (!(fps == 0 || (fps >= 1 && fps <= 1000)))
        throw Error("{} frames a second cannot be {}; give 1 to 1000, or 0 for as recorded", fps, what);
}

}  // namespace

BvhSettings::BvhSettings(const BvhOptions& options, const std::vector<std::string>& fields)
    : scale(read_scale(options.scale)) {
    check_rate(options.fps, "resampled to");
    check_rate(options.recorded_fps, "what was recorded");
    if (!(options.smooth >= 0 && options.smooth <= 1000))
        throw Error("smoothing over {} frames makes no sense; give 0 for none, or up to 1000",
                    options.smooth);
    if (options.persons > 100) throw Error("{} persons a clip are too many; give 1 to 100", options.persons);
    if (std::set<std::string>(options.classes.begin(), options.classes.end()).size() !=
        options.classes.size())
        throw Error("a class is listed twice: {}", fmt::join(options.classes, ","));
    check_fields(options.splits, fields);
    const auto axis = up_named(options.up);
    if (!axis) throw Error("{} is no axis that points up; give y, z, -y, -z, x or -x", in_quotes(options.up));
    up = *axis;
    if (!options.positions.empty()) {
        const auto named = positions_named(options.positions);
        if (!named || *named == Positions::told)
            throw Error("{} is nothing to do with positions; give replace, add or ignore",
                        in_quotes(options.positions));
        positions = *named;
    }
    if (!options.start.empty()) start = read_place("--start", options.start);
    if (!options.end.empty()) end = read_place("--end", options.end);
    if (end && end->in_seconds == start.in_seconds && end->value <= start.value)
        throw Error("--end {} is not after --start {}", options.end,
                    options.start.empty() ? "0" : options.start);
}

}  // namespace actformer::ingest
