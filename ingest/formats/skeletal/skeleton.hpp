// Which joints of a recording a dataset keeps.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ingest/dataset/topology.hpp"
#include "ingest/formats/skeletal/recording.hpp"

namespace actformer::ingest {

/// The joints below a root, the root included, in the file's order.
struct Skeleton {
    Topology topology;
    std::vector<bool> kept;  ///< (joints of the file)
    std::size_t root = 0;    ///< its index in the file
};

/// Index of the joint that carries the body through space. It is the hierarchy's root, unless that one's
/// position channels stand still in this file while those of its only child move: then the child, and so on
/// down. Many files put such a motionless joint on the floor above the hips. As the root it would lose the
/// body's motion, for all that is kept of a limb is its direction.
std::size_t automatic_root(const Recording& file);

/// Index of the joint called `name`; -1 where there is none.
int find_joint(const Recording& file, std::string_view name);

/// The skeleton that an example file gives. End sites, where wanted, become joints called "PARENT end", or
/// "PARENT end 2" for a joint's second; those that coincide with their parent, as placeholders do, are left
/// out.
Skeleton skeleton_below(const Recording& file, std::size_t root, bool end_sites);

/// The same, keeping of the end sites only those that `wanted` names: captures of one skeleton often differ
/// in these.
Skeleton skeleton_below(const Recording& file, std::size_t root, const Topology& wanted);

/// The first difference in words, as in "joint 'Head' is missing"; empty where joints of the same names hang together in the same
/// way, in whatever order.
std::string first_difference(const Topology& topology, const Topology& wanted);

}  // namespace actformer::ingest
