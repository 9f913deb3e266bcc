// The 22 joints of GTA Combat (Xu et al. 2023): those of JTA (Fabbri et al. 2018), of which the first and the 16th have changed places,
// so that the root is first.
#pragma once

#include <vector>

#include "ingest/dataset/known_topologies.hpp"

namespace actformer::ingest {

/// (22) metres, 0 for the root: the mean over the game's characters, as the public tools' gta_adjacency.h5 tells it.
std::vector<float> gta_bone_lengths();

/// The joint of GTA Combat that JTA counts as `joint`.
constexpr std::size_t gta_joint_of_jta(std::size_t joint) {
    return joint == 0 ? 15 : joint == 15 ? 0 : joint;
}

}  // namespace actformer::ingest
