#include "ingest/formats/motions/topology_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/printable.hpp"
#include "base/text/yaml.hpp"
#include "ingest/dataset/known_topologies.hpp"

namespace actformer::ingest {
namespace {

int parent_in(const YAML::Node& node, const std::vector<std::string>& names) {
    const auto text = node.IsNull() ? std::string("-1") : node.as<std::string>();
    const auto named = std::find(names.begin(), names.end(), text);
    return named != names.end() ? static_cast<int>(named - names.begin())
           : node.IsNull()      ? -1
                                : node.as<int>();
}

Topology topology_in(const std::string& path) {
    std::vector<char> scratch;
    const std::string text(read_text(path, scratch, largest_yaml));
    try {
        const auto node = YAML::Load(text);
        if (!node.IsMap() || !node["names"] || !node["names"].IsSequence() || !node["parents"] ||
            !node["parents"].IsSequence() || node["parents"].size() > most_joints)
            throw Error(
                "{}: a skeleton is told by names and parents, as in names: [hips, knee, foot], parents: [-1, "
                "0, 1]",
                path);
        if (const auto bad = bad_key(node)) throw Error("{}: line {}: {}", path, bad->line, bad->what);
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

Topology topology_called(const std::string& name_or_file) {
    std::vector<std::string_view> names;
    for (const auto& one : known_topologies()) {
        if (one.name == name_or_file) return one.topology;
        names.push_back(one.name);
    }
    if (!std::filesystem::exists(name_or_file))
        throw Error("no topology {}: neither a file nor one of {}", in_quotes(name_or_file),
                    fmt::join(names, ", "));
    return topology_in(name_or_file);
}

}  // namespace actformer::ingest
