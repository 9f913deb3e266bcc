// The joints of SMPL (Loper et al. 2015), without its body: what the rotations of AMASS, VIBE and AIST++ turn.
#pragma once

#include <string>
#include <vector>

#include "ingest/dataset/known_topologies.hpp"

namespace actformer::ingest {

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
