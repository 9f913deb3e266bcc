#include "ingest/formats/bvh/bvh_survey.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "ingest/formats/bvh/bvh_remarks.hpp"

namespace actformer::ingest {
namespace {

/// The same for two recordings whose joints have the same names and hang together in the same way.
std::string key_of(const Recording& recording, bool end_sites) {
    const auto topology = skeleton_below(recording, 0, end_sites).topology;
    std::vector<std::string> lines;
    for (std::size_t j = 0; j < topology.joints(); ++j)
        lines.push_back(topology.names[j] + "\n" +
                        (topology.parents[j] < 0 ? "" : topology.names[topology.parents[j]]));
    std::sort(lines.begin(), lines.end());
    return fmt::format("{}", fmt::join(lines, "\n\n"));
}

/// The value that comes most often; of those that come equally often, the one that comes first.
template <typename Value, typename Values>
Value commonest(const Values& values) {
    std::map<Value, std::pair<std::ptrdiff_t, std::ptrdiff_t>> counts;  // how often, and minus where first
    for (std::size_t i = 0; i < values.size(); ++i) {
        auto& count = counts.try_emplace(values[i], 0, -static_cast<std::ptrdiff_t>(i)).first->second;
        ++count.first;
    }
    return std::max_element(counts.begin(), counts.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

/// Rates as recorded, which files round differently, made comparable: to one in ten thousand.
double commonest_rate(const std::vector<const SurveyedFile*>& members) {
    std::vector<long> rounded;
    for (const auto* file : members) rounded.push_back(std::lround(std::log(file->fps) * 1e4));
    const long rate = commonest<long>(rounded);
    return (*std::find_if(members.begin(), members.end(),
                          [&](const auto* file) { return std::lround(std::log(file->fps) * 1e4) == rate; }))
        ->fps;
}

/// Persons in a file, or in the files of a group.
std::size_t commonest_persons(const std::vector<const SurveyedFile*>& members) {
    std::map<std::string, std::size_t> in_group;
    std::vector<std::size_t> counts;
    for (const auto* file : members) {
        if (file->group.empty())
            counts.push_back(file->persons);
        else
            in_group[file->group] += file->persons;
    }
    for (const auto& [group, persons] : in_group) counts.push_back(persons);
    return commonest<std::size_t>(counts);
}

}  // namespace

SurveyedFile BvhSurvey::look_at(std::vector<Recording>& persons, const BvhOptions& options,
                                const BvhSettings& settings) {
    Recording& first = persons.front();
    SurveyedFile file;
    file.fps = options.recorded_fps > 0 ? options.recorded_fps : first.fps();
    file.frames = first.frames;
    file.persons = persons.size();
    const int asked = find_joint(first, options.root);
    file.root = asked >= 0 ? static_cast<std::size_t>(asked) : automatic_root(first);
    file.root_name = first.joints[file.root].name;
    settle_positions(first, skeleton_below(first, file.root, true), settings.positions);
    file.stance = stance_of(first, file.root, options.skip_first);
    return file;
}

void BvhSurvey::add(SurveyedFile file, const Recording& first, bool end_sites) {
    file.tree = by_key_.try_emplace(key_of(first, end_sites), trees_.size()).first->second;
    if (file.tree == trees_.size()) trees_.push_back({file.index, {}, 0});
    Tree& tree = trees_[file.tree];
    if (tree.files++ == 0 || file.index < tree.first) {
        tree.first = file.index;
        tree.example.joints = first.joints;
    }
    files_.push_back(std::move(file));
}

std::size_t BvhSurvey::commonest_tree() const {
    const auto best = std::max_element(trees_.begin(), trees_.end(), [](const Tree& a, const Tree& b) {
        return a.files != b.files ? a.files < b.files : a.first > b.first;
    });
    return static_cast<std::size_t>(best - trees_.begin());
}

/// The joint that was asked for; else the one deepest down among those that carry the body in the files: above it nothing is lost,
/// as its motion has theirs in it. A single frame tells nothing of motion.
std::size_t BvhSurvey::root_of(const Tree& tree, const std::vector<const SurveyedFile*>& members,
                               const std::string& wanted) const {
    if (!wanted.empty()) {
        if (const int root = find_joint(tree.example, wanted); root >= 0)
            return static_cast<std::size_t>(root);
        std::vector<std::string> names;
        for (const auto& joint : tree.example.joints)
            if (!joint.end_site && !joint.pivot) names.push_back(joint.name);
        throw Error("no joint {} to take as root; the joints are {}", in_quotes(wanted),
                    fmt::join(names, ", "));
    }
    int root = 0;
    for (const auto* file : members)
        if (file->frames > 1) root = std::max(root, find_joint(tree.example, file->root_name));
    return static_cast<std::size_t>(root);
}

BvhDecision BvhSurvey::decide(const BvhOptions& options, const BvhSettings& settings) {
    if (files_.empty()) throw Error("no file is sound");
    std::sort(files_.begin(), files_.end(), [](const auto& a, const auto& b) { return a.index < b.index; });
    const std::size_t best = commonest_tree();
    std::vector<const SurveyedFile*> members, others;
    for (const auto& file : files_) (file.tree == best ? members : others).push_back(&file);

    BvhDecision out;
    const auto& example = trees_[best].example;
    out.topology =
        skeleton_below(example, root_of(trees_[best], members, options.root), options.end_sites).topology;
    out.fps = commonest_rate(members);
    out.persons = options.persons > 0 ? options.persons : commonest_persons(members);
    const Doubts doubts(members, settings.up);
    out.scale = settings.scale.value_or(static_cast<float>(fitting_scale(doubts.height())));
    out.remarks.push_back(root_remark(out.topology, example));
    for (auto& remark : doubts.remarks(out.scale, !settings.scale)) out.remarks.push_back(std::move(remark));
    std::vector<std::string> other_names;
    for (const auto* file : others) {
        const auto& other = trees_[file->tree].example;
        const int root = find_joint(other, out.topology.names[0]);
        if (root < 0 ||
            !first_difference(skeleton_below(other, static_cast<std::size_t>(root), out.topology).topology,
                              out.topology)
                 .empty())
            other_names.push_back(file->name);
    }
    if (!other_names.empty()) out.remarks.push_back(skeleton_remark(members.size(), other_names));
    return out;
}

}  // namespace actformer::ingest
