// The ST-GCN's graph: which joints are neighbours, and how a graph convolution parts a joint's neighbourhood (Yan et al., AAAI
// 2018, section 3.3, "spatial configuration partitioning").
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace actformer::eval {

/// A tree of joints and the joint at its centre.
struct Graph {
    std::vector<int> parents;  ///< (K) -1 for the root
    std::uint32_t center = 0;

    std::uint32_t joints() const { return static_cast<std::uint32_t>(parents.size()); }
    bool operator==(const Graph&) const = default;
};

/// The public edges of NTU's 25 joints: hands run tip, thumb, hand, unlike the limbs; the centre is the spine at the shoulders
/// (20).
const Graph& ntu_graph();

/// The graph of a recogniser for nodes with these parents: ntu_graph() for NTU's 25 joints, else the tree itself about its
/// root.
Graph recogniser_graph(const std::vector<int>& parents);

/// Dense (K, K): row the source v, column the joint w that gathers.
using Adjacency = std::vector<double>;

/// Three parts: the joint itself; neighbours as far from the centre as it or farther; neighbours closer. Columns are
/// normalised by degree. As in the public ST-GCN, distances from the centre are known up to one hop and all beyond count as
/// equal. `graph` must be a tree.
std::array<Adjacency, 3> partition(const Graph& graph);

}  // namespace actformer::eval
