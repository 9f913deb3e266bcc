#include "ingest/formats/motions/topology_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/printable.hpp"
#include "ingest/formats/gta/gta_skeleton.hpp"
#include "ingest/smpl/smpl24.hpp"

namespace actformer::ingest {
namespace {

struct Known {
    std::string_view name;
    Topology topology;
};

/// Kinect v2's 25, SMPL's 24 (Loper et al. 2015), COCO's 17 key points with the nose for a root, the 17 of Human3.6M as VideoPose3D
/// orders them, and the 22 of GTA Combat, which are those of JTA with the pelvis first.
const std::vector<Known>& known() {
    static const std::vector<Known> all{
        {"ntu25", ntu25()},
        {"smpl24", smpl24()},
        {"coco17",
         {{"nose", "left eye", "right eye", "left ear", "right ear", "left shoulder", "right shoulder",
           "left elbow", "right elbow", "left wrist", "right wrist", "left hip", "right hip", "left knee",
           "right knee", "left ankle", "right ankle"},
          {-1, 0, 0, 1, 2, 0, 0, 5, 6, 7, 8, 5, 6, 11, 12, 13, 14}}},
        {"h36m17",
         {{"pelvis", "right hip", "right knee", "right ankle", "left hip", "left knee", "left ankle", "spine",
           "thorax", "neck", "head", "left shoulder", "left elbow", "left wrist", "right shoulder",
           "right elbow", "right wrist"},
          {-1, 0, 1, 2, 0, 4, 5, 0, 7, 8, 9, 8, 11, 12, 8, 14, 15}}},
        {"gta22", gta22()}};
    return all;
}

constexpr std::uint64_t largest_file = std::uint64_t{16} << 20;
constexpr std::size_t most_joints = 4096;

int parent_in(const YAML::Node& node, const std::vector<std::string>& names) {
    const auto text = node.IsNull() ? std::string("-1") : node.as<std::string>();
    const auto named = std::find(names.begin(), names.end(), text);
    return named != names.end() ? static_cast<int>(named - names.begin())
           : node.IsNull()      ? -1
                                : node.as<int>();
}

Topology topology_in(const std::string& path) {
    std::vector<char> scratch;
    const std::string text(read_text(path, scratch, largest_file));
    try {
        const auto node = YAML::Load(text);
        if (!node.IsMap() || !node["names"].IsSequence() || !node["parents"].IsSequence() ||
            node["parents"].size() > most_joints)
            throw Error(
                "{}: a skeleton is told by names and parents, as in names: [hips, knee, foot], parents: [-1, "
                "0, 1]",
                path);
        Topology topology;
        for (const auto& name : node["names"]) topology.names.push_back(printable(name.as<std::string>()));
        for (const auto& parent : node["parents"])
            topology.parents.push_back(parent_in(parent, topology.names));
        topology.check(path);
        return topology;
    } catch (const YAML::Exception& e) {
        throw Error("{}: line {}: {}", path, e.mark.line + 1, printable(e.msg));
    }
}

}  // namespace

std::vector<std::string_view> known_topologies() {
    std::vector<std::string_view> names;
    for (const auto& one : known()) names.push_back(one.name);
    return names;
}

Topology topology_called(const std::string& name_or_file) {
    for (const auto& one : known())
        if (one.name == name_or_file) return one.topology;
    if (!std::filesystem::exists(name_or_file))
        throw Error("no topology {}: neither a file nor one of {}", in_quotes(name_or_file),
                    fmt::join(known_topologies(), ", "));
    return topology_in(name_or_file);
}

}  // namespace actformer::ingest
