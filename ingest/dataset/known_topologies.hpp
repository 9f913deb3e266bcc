// Skeletons that have a name.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "ingest/dataset/topology.hpp"

namespace actformer::ingest {

struct KnownTopology {
    std::string_view name;
    Topology topology;
};

/// "ntu25", "smpl24", "coco17", "h36m17", "gta22", "common15"
const std::vector<KnownTopology>& known_topologies();

inline constexpr std::size_t smpl_joints = 24;

/// Parents of smpl24(); every joint comes after its parent.
inline constexpr std::array<int, smpl_joints> smpl24_parents{-1, 0, 0, 0,  1,  2,  3,  4,  5,  6,  7,  8,
                                                             9,  9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};

/// SMPL's 24 joints in its order (Loper et al. 2015); every joint comes after its parent.
const Topology& smpl24();

inline constexpr std::size_t gta_joints = 22;

/// Parents of gta22().
inline constexpr std::array<int, gta_joints> gta22_parents{-1, 2,  11, 2, 3, 4, 5,  2,  7, 8,  9,
                                                           12, 13, 14, 0, 1, 0, 16, 17, 0, 19, 20};

/// The 22 joints of GTA Combat: those of JTA (Fabbri et al. 2018), the pelvis first.
const Topology& gta22();

/// The 15 joints that ntu25(), gta22() and smpl24() have in common: pelvis, neck, head; left arm, right arm, left leg, right leg.
const Topology& common15();

}  // namespace actformer::ingest
