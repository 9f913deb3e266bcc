#include "ingest/formats/skeletal/persons.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

namespace actformer::ingest {
namespace {

/// How names of one skeleton become those of another: one beginning and one end in place of another.
class Renaming {
  public:
    /// The one that makes `to` of `from`. What both names share tells which end differs.
    Renaming(std::string_view from, std::string_view to) {
        const auto shorter = std::min(from.size(), to.size());
        std::size_t begin = 0, end = 0;
        while (begin < shorter && from[begin] == to[begin]) ++begin;
        while (end < shorter - begin && from[from.size() - 1 - end] == to[to.size() - 1 - end]) ++end;
        if (end == 0) {  // they differ at the end alone
            from_end_ = from.substr(begin);
            to_end_ = to.substr(begin);
        } else {
            from_begin_ = from.substr(0, from.size() - end);
            to_begin_ = to.substr(0, to.size() - end);
        }
    }

    std::optional<std::string> operator()(std::string_view name) const {
        if (!name.starts_with(from_begin_)) return {};
        name.remove_prefix(from_begin_.size());
        if (!name.ends_with(from_end_)) return {};
        name.remove_suffix(from_end_.size());
        return fmt::format("{}{}{}", to_begin_, name, to_end_);
    }

  private:
    std::string from_begin_, from_end_, to_begin_, to_end_;
};

std::variant<Skeleton, std::string> find_by_name(const Recording& person, const Topology& wanted) {
    const int root = find_joint(person, wanted.names[0]);
    if (root < 0) return fmt::format("no joint '{}', the root", wanted.names[0]);
    auto skeleton = skeleton_below(person, static_cast<std::size_t>(root), wanted);
    auto difference = first_difference(skeleton.topology, wanted);
    if (!difference.empty()) return difference;
    return skeleton;
}

std::optional<std::vector<RecordedJoint>> renamed(const Recording& person, const Renaming& rename) {
    auto joints = person.joints;
    for (auto& joint : joints) {
        if (joint.end_site || joint.pivot) continue;
        auto name = rename(joint.name);
        if (!name) return {};
        joint.name = std::move(*name);
    }
    return joints;
}

}  // namespace

std::variant<Skeleton, std::string> find_skeleton(Recording& person, const Topology& wanted) {
    auto by_name = find_by_name(person, wanted);
    if (std::holds_alternative<Skeleton>(by_name)) return by_name;
    // The root is the hierarchy's, or one below it with nothing between that branches.
    for (std::size_t j = 0; j < person.joints.size() && person.joints[j].parent == static_cast<int>(j) - 1;
         ++j) {
        if (person.joints[j].end_site || person.joints[j].pivot) break;
        auto joints = renamed(person, Renaming(person.joints[j].name, wanted.names[0]));
        if (!joints) continue;
        std::swap(person.joints, *joints);
        auto found = find_by_name(person, wanted);
        if (std::holds_alternative<Skeleton>(found)) return found;
        std::swap(person.joints, *joints);
    }
    return by_name;
}

}  // namespace actformer::ingest
