// Skeletons as graphs, their coarsening, and the fixed matrices that sum input nodes into output nodes.
#pragma once

#include <cstdint>
#include <vector>

namespace actformer::model {

/// An undirected graph of few nodes.
struct NodeGraph {
    std::vector<std::vector<std::uint32_t>> neighbours;  ///< of each node, ascending

    std::uint32_t nodes() const { return static_cast<std::uint32_t>(neighbours.size()); }
};

/// `parents` as in ingest::Topology: -1 for the root.
NodeGraph graph_of_tree(const std::vector<int>& parents);

/// Edges of the shortest path between any two nodes, (nodes, nodes); -1 where there is none.
std::vector<std::vector<int>> path_lengths(const NodeGraph& graph);

/// Which of two sets that measure alike is kept, as a body's left and right do.
enum class Mirror {
    either,  ///< no matter, though always the same of a graph
    first    ///< the one with the smallest node that the other has not
};

/// The maximal independent set to keep, ascending: largest degree sum, then largest mean betweenness, largest mean
/// closeness, smallest mean eccentricity, fewest nodes, smallest index sum.
std::vector<std::uint32_t> kept_nodes(const NodeGraph& graph, Mirror mirror = Mirror::either);

/// The graph of the kept nodes, in their order: those at most 3 hops apart are joined.
NodeGraph coarsened(const NodeGraph& graph, const std::vector<std::uint32_t>& kept);

/// Numbers (hops, outputs, inputs) row-major.
struct HopMatrix {
    std::uint32_t hops = 2, outputs = 0, inputs = 0;
    std::vector<float> values;

    float at(std::size_t hop, std::size_t output, std::size_t input) const {
        return values[(hop * outputs + output) * inputs + input];
    }
    /// Whether the numbers of a node at this distance reach any output.
    bool feeds(std::size_t hop, std::size_t input) const;
};

/// From all nodes of `graph` to the kept ones: 1 where they are `hop` = 0 or 1 edges apart, over the root of the row's count
/// times the column's.
HopMatrix hop_matrix(const NodeGraph& graph, const std::vector<std::uint32_t>& kept);

/// hop_matrix() with its hop 1 in two: what comes to an output from nearer the graph's centre, then what comes from farther
/// out. The centre is the node of the largest betweenness; of nodes as far or as large, the smaller index is nearer.
HopMatrix radial_hop_matrix(const NodeGraph& graph, const std::vector<std::uint32_t>& kept);

/// The other way: from the kept nodes to all.
HopMatrix transposed(const HopMatrix& matrix);

/// A skeleton and its two coarsenings.
struct SkeletonLevels {
    NodeGraph fine, middle, coarse;
    std::vector<std::uint32_t> middle_kept;  ///< nodes of fine
    std::vector<std::uint32_t> coarse_kept;  ///< nodes of middle
};

SkeletonLevels skeleton_levels(const std::vector<int>& parents, Mirror mirror = Mirror::either);

/// 0 1 .. n-1
std::vector<std::uint32_t> all_nodes(const NodeGraph& graph);

}  // namespace actformer::model
