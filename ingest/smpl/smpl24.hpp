// The joints of SMPL (Loper et al. 2015), without its body: what the rotations of AMASS, VIBE and AIST++ turn.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ingest/dataset/known_topologies.hpp"

namespace actformer::ingest {

inline constexpr std::size_t smpl_joints = 24;

/// Parents of smpl24(); every joint comes after its parent.
inline constexpr std::array<int, smpl_joints> smpl24_parents{-1, 0, 0, 0,  1,  2,  3,  4,  5,  6,  7,  8,
                                                             9,  9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};

/// The rest pose that rotations turn: a T, facing +z, up +y, left +x.
struct RestSkeleton {
    std::vector<double> offsets;  ///< (24, 3) metres from the parent; the root's from the origin of the body
    std::string source;           ///< "generic", or the name of the model file it was read from

    std::vector<float> rest() const { return {offsets.begin(), offsets.end()}; }  ///< as BodyModel has it
};

/// The mean T-pose of eight subjects of the CMU motion capture database on SMPL's tree, left and right alike: for rotations of
/// bodies whose model file is not at hand. CMU's skeletons have other joints along the spine, so that the division of spine and
/// collar, and the length of the hand, are this program's own.
RestSkeleton generic_skeleton();

}  // namespace actformer::ingest
