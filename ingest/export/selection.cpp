#include "ingest/export/selection.hpp"

#include <algorithm>
#include <set>
#include <unordered_set>

#include "base/error.hpp"
#include "base/text/first_few.hpp"
#include "base/text/printable.hpp"
#include "base/text/suggestion.hpp"
#include "ingest/dataset/classes.hpp"

namespace actformer::ingest {
namespace {

void keep_named(std::vector<std::size_t>& picks, const ClipSource& source, const Selection& selection) {
    std::unordered_set<std::string> wanted(selection.clips.begin(), selection.clips.end());
    std::unordered_set<std::string> there;
    for (const auto& clip : source.clips()) there.insert(clip.name);
    for (const auto& name : selection.clips)
        if (!there.contains(name))
            throw Error("{}: no clip {}; its clips are called as {}{}", source.path().string(),
                        in_quotes(name), in_quotes(source.clips()[0].name),
                        suggestion(name, {there.begin(), there.end()}));
    std::erase_if(picks, [&](std::size_t i) { return !wanted.contains(source.clips()[i].name); });
}

/// The conditions as they were given, for a message.
std::string in_words(const Selection& selection) {
    std::string words =
        selection.split == "all" ? "" : fmt::format(" of split {}", in_quotes(selection.split));
    if (!selection.label.empty()) words += fmt::format(" of class {}", in_quotes(selection.label));
    if (!selection.clips.empty()) words += " among those named";
    return words;
}

/// "; it has clips of walking, running"; of many the first.
std::string classes_there(const ClipSource& source) {
    const auto& names = source.subjects().classes;
    std::set<std::uint32_t> labels;
    for (const auto& clip : source.clips())
        if (clip.label && *clip.label < names.size()) labels.insert(*clip.label);
    std::vector<std::string> there;
    for (const auto label : labels) there.push_back(printable(names[label]));
    constexpr std::size_t most = 8;
    return there.empty() ? "" : "; it has clips of " + few_and_more(there, most);
}

}  // namespace

std::vector<std::size_t> selected(const ClipSource& source, const Selection& selection) {
    auto picks = source.split(selection.split);
    if (!selection.clips.empty() && !source.clips().empty()) keep_named(picks, source, selection);
    if (!selection.label.empty()) {
        const auto label = label_called(selection.label, source.subjects().classes, source.path().string());
        std::erase_if(picks, [&](std::size_t i) { return source.clips()[i].label != label; });
    }
    if (picks.empty())
        throw Error("{}: holds no clip{}{}", source.path().string(), in_words(selection),
                    classes_there(source));
    if (selection.count == 0 || selection.count >= picks.size()) return picks;
    std::vector<std::size_t> some;
    for (std::size_t i = 0; i < selection.count; ++i)
        some.push_back(picks[i * picks.size() / selection.count]);
    return some;
}

ExportClip with_person(ExportClip clip, std::uint32_t person, const std::string& where) {
    if (person == 0) return clip;
    auto& motion = clip.motion;
    if (person > motion.persons)
        throw Error("{}: clip {} has {} person{}, no number {}", where, clip.name, motion.persons,
                    motion.persons == 1 ? "" : "s", person);
    const std::size_t body = std::size_t{motion.nodes} * motion.numbers;
    std::vector<float> values;
    values.reserve(motion.frames * body);
    for (std::size_t t = 0; t < motion.frames; ++t) {
        const float* from = motion.at(t, person - 1, 0);
        values.insert(values.end(), from, from + body);
    }
    motion.values = std::move(values);
    motion.persons = 1;
    auto& lengths = clip.body.bone_length;
    const auto joints = static_cast<std::ptrdiff_t>(clip.body.topology.joints());
    const auto known = static_cast<std::ptrdiff_t>(lengths.size()) / joints;
    if (known > 0) {
        const auto from = lengths.begin() + (person <= known ? person - 1 : 0) * joints;
        lengths = std::vector<float>(from, from + joints);
    }
    return clip;
}

}  // namespace actformer::ingest
