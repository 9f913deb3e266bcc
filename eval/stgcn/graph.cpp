#include "eval/stgcn/graph.hpp"

#include <algorithm>

#include "ingest/dataset/topology.hpp"

namespace actformer::eval {
namespace {

/// (K, K): 1 where two joints are the same or neighbours.
std::vector<char> links(const Graph& graph) {
    const std::size_t joints = graph.joints();
    std::vector<char> linked(joints * joints, 0);
    for (std::size_t k = 0; k < joints; ++k) {
        linked[k * joints + k] = 1;
        if (graph.parents[k] < 0) continue;
        const auto parent = static_cast<std::size_t>(graph.parents[k]);
        linked[k * joints + parent] = linked[parent * joints + k] = 1;
    }
    return linked;
}

}  // namespace

const Graph& ntu_graph() {
    static const Graph graph{
        {-1, 0, 20, 2, 20, 4, 5, 6, 20, 8, 9, 10, 0, 12, 13, 14, 0, 16, 17, 18, 1, 22, 7, 24, 11}, 20};
    return graph;
}

Graph recogniser_graph(const std::vector<int>& parents) {
    if (parents == ingest::ntu25().parents) return ntu_graph();
    const auto root = std::find(parents.begin(), parents.end(), -1) - parents.begin();
    return {parents, static_cast<std::uint32_t>(root)};
}

std::array<Adjacency, 3> partition(const Graph& graph) {
    const std::size_t joints = graph.joints();
    const auto linked = links(graph);
    const auto hops = [&](std::size_t k) {
        return k == graph.center ? 0 : linked[k * joints + graph.center] ? 1 : 2;
    };
    std::array<Adjacency, 3> parts;
    for (auto& part : parts) part.assign(joints * joints, 0.0);
    for (std::size_t w = 0; w < joints; ++w) {
        double degree = 0;
        for (std::size_t v = 0; v < joints; ++v) degree += linked[v * joints + w];
        for (std::size_t v = 0; v < joints; ++v)
            if (linked[v * joints + w])
                parts[v == w ? 0 : hops(v) >= hops(w) ? 1 : 2][v * joints + w] = 1 / degree;
    }
    return parts;
}

}  // namespace actformer::eval
