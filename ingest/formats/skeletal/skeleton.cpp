#include "ingest/formats/skeletal/skeleton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <unordered_map>
#include <unordered_set>

namespace actformer::ingest {
namespace {

/// A position channel of `joint` changes over the frames.
bool travels(const Recording& file, std::size_t joint) {
    const auto& channels = file.joints[joint].channels;
    for (std::uint32_t c = 0; c < channels.size(); ++c) {
        if (channels[c] >= kernels::Channel::x_rotation) continue;
        const auto values = file.channel(file.joints[joint].first_channel + c);
        if (std::any_of(values.begin(), values.end(), [&](float v) { return v != values[0]; })) return true;
    }
    return false;
}

/// The one joint below `joint`; 0, which is below none, where there are none or several.
std::size_t only_child(const Recording& file, std::size_t joint) {
    std::size_t child = 0;
    for (std::size_t j = joint + 1; j < file.joints.size(); ++j) {
        if (file.joints[j].end_site || file.joints[j].parent != static_cast<int>(joint)) continue;
        if (child != 0) return 0;
        child = j;
    }
    return child;
}

bool is_placeholder(const RecordedJoint& joint) {
    return std::all_of(joint.offset.begin(), joint.offset.end(), [](double o) { return o == 0; });
}

/// Names for end sites, all different and different from the joints'.
class EndNames {
  public:
    explicit EndNames(const Recording& file) {
        for (const auto& joint : file.joints)
            if (!joint.end_site) taken_.insert(joint.name);
    }

    std::string next(const std::string& parent) {
        std::string name = parent + " end";
        for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{} end {}", parent, i);
        return name;
    }

  private:
    std::unordered_set<std::string> taken_;
};

using WantedEnd = std::function<bool(const std::string& name)>;

Skeleton skeleton(const Recording& file, std::size_t root, const WantedEnd& wanted) {
    Skeleton out;
    out.root = root;
    out.kept.assign(file.joints.size(), false);
    EndNames end_names(file);
    std::vector<int> index(file.joints.size(),
                           -1);  // among those kept, of the joint or of the nearest kept above it
    for (std::size_t j = root; j < file.joints.size(); ++j) {
        const RecordedJoint& joint = file.joints[j];
        const int above = joint.parent < 0 ? -1 : index[joint.parent];
        if (j != root && above < 0) continue;
        index[j] = above;
        if (joint.pivot) continue;
        const auto name = joint.end_site ? end_names.next(file.joints[joint.parent].name) : joint.name;
        if (joint.end_site && (is_placeholder(joint) || !wanted(name))) continue;
        out.kept[j] = true;
        index[j] = static_cast<int>(out.topology.joints());
        out.topology.names.push_back(name);
        out.topology.parents.push_back(j == root ? -1 : above);
    }
    return out;
}

std::unordered_map<std::string, std::size_t> indices(const Topology& topology) {
    std::unordered_map<std::string, std::size_t> out;
    for (std::size_t j = 0; j < topology.joints(); ++j) out.emplace(topology.names[j], j);
    return out;
}

std::string parent_name(const Topology& topology, std::size_t joint) {
    return topology.parents[joint] < 0 ? "" : topology.names[topology.parents[joint]];
}

}  // namespace

std::size_t automatic_root(const Recording& file) {
    std::size_t root = 0;
    while (!travels(file, root)) {
        const std::size_t child = only_child(file, root);
        if (child == 0 || !travels(file, child)) break;
        root = child;
    }
    return root;
}

int find_joint(const Recording& file, std::string_view name) {
    const auto found = std::find_if(file.joints.begin(), file.joints.end(), [&](const RecordedJoint& j) {
        return !j.end_site && !j.pivot && j.name == name;
    });
    return found == file.joints.end() ? -1 : static_cast<int>(found - file.joints.begin());
}

Skeleton skeleton_below(const Recording& file, std::size_t root, bool end_sites) {
    return skeleton(file, root, [&](const std::string&) { return end_sites; });
}

Skeleton skeleton_below(const Recording& file, std::size_t root, const Topology& wanted) {
    const std::unordered_set<std::string> names(wanted.names.begin(), wanted.names.end());
    return skeleton(file, root, [&](const std::string& name) { return names.contains(name); });
}

std::string first_difference(const Topology& topology, const Topology& wanted) {
    const auto known = indices(wanted), there = indices(topology);
    for (const auto& name : wanted.names)
        if (!there.contains(name)) return fmt::format("joint '{}' is missing", name);
    for (std::size_t j = 0; j < topology.joints(); ++j) {
        const auto& name = topology.names[j];
        const auto found = known.find(name);
        if (found == known.end()) return fmt::format("one joint too many: '{}'", name);
        const auto above = parent_name(topology, j), wanted_above = parent_name(wanted, found->second);
        if (above != wanted_above)
            return fmt::format("'{}' hangs below '{}', not '{}'", name, above, wanted_above);
    }
    return {};
}

}  // namespace actformer::ingest
