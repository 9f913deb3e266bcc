#include "ingest/bvh/skeleton.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace actformer::ingest {
namespace {

/// A position channel of `joint` changes over the frames.
bool travels(const BvhFile& file, std::size_t joint) {
    const auto& channels = file.joints[joint].channels;
    for (std::uint32_t c = 0; c < channels.size(); ++c) {
        if (channels[c] >= kernels::Channel::x_rotation) continue;
        const auto values = file.channel(file.joints[joint].first_channel + c);
        if (std::any_of(values.begin(), values.end(), [&](float v) { return v != values[0]; })) return true;
    }
    return false;
}

/// The one joint below `joint`; 0, which is below none, where there are none or several.
std::size_t only_child(const BvhFile& file, std::size_t joint) {
    std::size_t child = 0;
    for (std::size_t j = joint + 1; j < file.joints.size(); ++j) {
        if (file.joints[j].end_site || file.joints[j].parent != static_cast<int>(joint)) continue;
        if (child != 0) return 0;
        child = j;
    }
    return child;
}

bool is_placeholder(const BvhJoint& joint) {
    return std::all_of(joint.offset.begin(), joint.offset.end(), [](double o) { return o == 0; });
}

/// A name that neither a joint of the file nor an end site before has.
std::string end_name(const BvhFile& file, const Topology& topology, const std::string& parent) {
    const auto taken = [&](const std::string& name) {
        return find_joint(file, name) >= 0 ||
               std::find(topology.names.begin(), topology.names.end(), name) != topology.names.end();
    };
    std::string name = parent + " end";
    for (int i = 2; taken(name); ++i) name = fmt::format("{} end {}", parent, i);
    return name;
}

std::string described(const Topology& topology, std::size_t joint, bool with_parent) {
    if (!with_parent) return fmt::format("'{}'", topology.names[joint]);
    return fmt::format("'{}' below '{}'", topology.names[joint], topology.names[topology.parents[joint]]);
}

}  // namespace

std::size_t automatic_root(const BvhFile& file) {
    std::size_t root = 0;
    while (!travels(file, root)) {
        const std::size_t child = only_child(file, root);
        if (child == 0 || !travels(file, child)) break;
        root = child;
    }
    return root;
}

int find_joint(const BvhFile& file, std::string_view name) {
    const auto found = std::find_if(file.joints.begin(), file.joints.end(),
                                    [&](const BvhJoint& j) { return !j.end_site && j.name == name; });
    return found == file.joints.end() ? -1 : static_cast<int>(found - file.joints.begin());
}

Skeleton skeleton_below(const BvhFile& file, std::size_t root, bool end_sites) {
    Skeleton out;
    out.root = root;
    out.kept.assign(file.joints.size(), false);
    std::vector<int> index(file.joints.size(), -1);  // among those kept
    for (std::size_t j = root; j < file.joints.size(); ++j) {
        const BvhJoint& joint = file.joints[j];
        const bool below = j == root || (joint.parent >= 0 && out.kept[joint.parent]);
        if (!below || (joint.end_site && (!end_sites || is_placeholder(joint)))) continue;
        const int parent = j == root ? -1 : index[joint.parent];
        out.kept[j] = true;
        index[j] = static_cast<int>(out.topology.joints());
        out.topology.names.push_back(joint.end_site ? end_name(file, out.topology, out.topology.names[parent])
                                                    : joint.name);
        out.topology.parents.push_back(parent);
    }
    return out;
}

std::string first_difference(const Topology& topology, const Topology& wanted) {
    for (std::size_t j = 0; j < std::min(topology.joints(), wanted.joints()); ++j) {
        const bool same_name = topology.names[j] == wanted.names[j];
        if (same_name && topology.parents[j] == wanted.parents[j]) continue;
        return fmt::format("joint {} is {}, not {}", j, described(topology, j, same_name),
                           described(wanted, j, same_name));
    }
    if (topology.joints() < wanted.joints())
        return fmt::format("joint '{}' is missing", wanted.names[topology.joints()]);
    if (topology.joints() > wanted.joints())
        return fmt::format("one joint too many: '{}'", topology.names[wanted.joints()]);
    return {};
}

}  // namespace actformer::ingest
