#include "model/recognisers/graph.hpp"

#include <algorithm>

namespace actformer::model {
namespace {

/// 1 where two joints are the same or neighbours, (K, K).
std::vector<char> neighbours(const Graph& graph) {
    const std::size_t joints = graph.joints();
    std::vector<char> near(joints * joints, 0);
    for (std::size_t child = 0; child < joints; ++child) {
        near[child * joints + child] = 1;
        if (graph.parents[child] < 0) continue;
        const auto parent = static_cast<std::size_t>(graph.parents[child]);
        near[child * joints + parent] = near[parent * joints + child] = 1;
    }
    return near;
}

}  // namespace

const Graph& ntu_graph() {
    static const Graph graph{
        {-1, 0, 20, 2, 20, 4, 5, 6, 20, 8, 9, 10, 0, 12, 13, 14, 0, 16, 17, 18, 1, 22, 7, 24, 11}, 20};
    return graph;
}

Graph recogniser_graph(const ingest::Topology& topology) {
    if (topology.parents == ingest::ntu25().parents) return ntu_graph();
    const auto root =
        std::find(topology.parents.begin(), topology.parents.end(), -1) - topology.parents.begin();
    return {topology.parents, static_cast<std::uint32_t>(root)};
}

std::vector<float> spatial_partition(const Graph& graph) {
    const std::size_t joints = graph.joints();
    const auto near = neighbours(graph);
    // Distance from the centre: 0, 1, or 2 for all that lies beyond one hop.
    std::vector<int> distance(joints, 2);
    for (std::size_t j = 0; j < joints; ++j)
        if (near[j * joints + graph.center] != 0) distance[j] = j == graph.center ? 0 : 1;

    std::vector<float> partition(3 * joints * joints, 0.0F);
    for (std::size_t target = 0; target < joints; ++target) {
        std::size_t degree = 0;
        for (std::size_t source = 0; source < joints; ++source) degree += near[source * joints + target] != 0;
        for (std::size_t source = 0; source < joints; ++source) {
            if (near[source * joints + target] == 0) continue;
            const std::size_t part = source == target ? 0 : distance[source] >= distance[target] ? 1 : 2;
            partition[(part * joints + source) * joints + target] =
                static_cast<float>(1.0 / static_cast<double>(degree));
        }
    }
    return partition;
}

}  // namespace actformer::model
