// The recogniser's graph: which joints are neighbours, and their spatial-configuration partition (DESIGN 4.8).
#pragma once

#include <cstdint>
#include <vector>

#include "ingest/dataset/topology.hpp"

namespace actformer::model {

/// A tree of joints with the one that the others are nearer to or farther from.
struct Graph {
    std::vector<int> parents;  ///< -1 for the root
    std::uint32_t center = 0;

    std::uint32_t joints() const { return static_cast<std::uint32_t>(parents.size()); }
    bool operator==(const Graph&) const = default;
};

/// NTU's 25 joints get the public tools' edges, whose hands run tip-thumb-hand, unlike the limbs, about the spine at the
/// shoulders (20). Any other skeleton keeps its own parents about its root.
Graph recogniser_graph(const ingest::Topology& topology);

/// The public edges of NTU's 25 joints.
const Graph& ntu_graph();

/// (3, K, K) row-major, [part][source][target]: the joint itself; neighbours as far from the centre or farther; closer.
/// Columns are normalised by degree. As in the public ST-GCN distances are known up to one hop: all beyond count as equal.
std::vector<float> spatial_partition(const Graph& graph);

}  // namespace actformer::model
