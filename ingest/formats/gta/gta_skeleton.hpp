// The 22 joints of GTA Combat (Xu et al. 2023): those of JTA (Fabbri et al. 2018), of which the first and the 16th have changed places,
// so that the root is first.
#pragma once

#include <array>
#include <vector>

#include "ingest/dataset/topology.hpp"

namespace actformer::ingest {

inline constexpr std::size_t gta_joints = 22;

inline constexpr std::array<int, gta_joints> gta22_parents{-1, 2,  11, 2, 3, 4, 5,  2,  7, 8,  9,
                                                           12, 13, 14, 0, 1, 0, 16, 17, 0, 19, 20};

const Topology& gta22();

/// (22) metres, 0 for the root: the mean over the game's characters, as the public tools' gta_adjacency.h5 tells it.
std::vector<float> gta_bone_lengths();

/// The joint of GTA Combat that JTA counts as `joint`.
constexpr std::size_t gta_joint_of_jta(std::size_t joint) {
    return joint == 0 ? 15 : joint == 15 ? 0 : joint;
}

}  // namespace actformer::ingest
