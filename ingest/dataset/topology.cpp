#include "ingest/dataset/topology.hpp"

#include <algorithm>
#include <set>

#include "base/error.hpp"

namespace actformer::ingest {

std::vector<std::uint32_t> Topology::order() const {
    std::vector<std::uint32_t> out;
    std::vector<bool> placed(joints(), false);
    out.reserve(joints());
    for (std::size_t round = 0; round < joints() && out.size() < joints(); ++round)
        for (std::uint32_t j = 0; j < joints(); ++j)
            if (!placed[j] && (parents[j] < 0 || placed[parents[j]])) {
                placed[j] = true;
                out.push_back(j);
            }
    return out;
}

void Topology::check(const std::string& where) const {
    const auto k = static_cast<int>(joints());
    if (k == 0 || names.size() != parents.size())
        throw Error("{}: {} joint names for {} parents; give one name a joint", where, names.size(), k);
    if (joints() > most_joints)
        throw Error("{}: {} joints, and a body may have {}", where, joints(), most_joints);
    if (parents[0] != -1) throw Error("{}: joint 0 ({}) must be the root, with parent -1", where, names[0]);
    for (int j = 1; j < k; ++j)
        if (parents[j] < 0 || parents[j] >= k || parents[j] == j)
            throw Error("{}: joint {} ({}) has parent {}, which is no other joint", where, j, names[j],
                        parents[j]);
    if (const auto reached = order().size(); reached != joints())
        throw Error("{}: the joints are no tree: {} of {} hang on a cycle", where, k - reached, k);
    if (const std::set<std::string> unique(names.begin(), names.end()); unique.size() != names.size())
        throw Error("{}: two joints have the same name", where);
}

const Topology& ntu25() {
    static const Topology topology{
        {"pelvis",      "spine",      "neck",       "head",           "left shoulder",
         "left elbow",  "left wrist", "left hand",  "right shoulder", "right elbow",
         "right wrist", "right hand", "left hip",   "left knee",      "left ankle",
         "left foot",   "right hip",  "right knee", "right ankle",    "right foot",
         "chest",       "left tip",   "left thumb", "right tip",      "right thumb"},
        {ntu25_parents.begin(), ntu25_parents.end()}};
    return topology;
}

}  // namespace actformer::ingest
