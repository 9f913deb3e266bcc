#include "model/generators/graph/coarsening.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace actformer::model {
namespace {

using Nodes = std::vector<std::uint32_t>;

/// What a set is judged by, summed over its nodes, each the larger the better: degree, betweenness, closeness, minus
/// eccentricity, minus index.
using Worth = std::array<double, 5>;

constexpr std::size_t index_place = 4;

/// Betweenness by Brandes' accumulation: the shortest paths from `source` are counted, then their shares flow back.
void add_betweenness(const NodeGraph& graph, std::uint32_t source, std::vector<Worth>& worths) {
    const auto n = graph.nodes();
    std::vector<int> distance(n, -1);
    std::vector<double> paths(n, 0), share(n, 0);
    Nodes order{source};
    distance[source] = 0;
    paths[source] = 1;
    for (std::size_t i = 0; i < order.size(); ++i)
        for (const auto next : graph.neighbours[order[i]]) {
            if (distance[next] < 0) {
                distance[next] = distance[order[i]] + 1;
                order.push_back(next);
            }
            if (distance[next] == distance[order[i]] + 1) paths[next] += paths[order[i]];
        }
    for (std::size_t i = order.size(); i-- > 1;) {
        const auto node = order[i];
        for (const auto before : graph.neighbours[node])
            if (distance[before] == distance[node] - 1)
                share[before] += paths[before] / paths[node] * (1 + share[node]);
        worths[node][1] += share[node];
    }
}

std::vector<Worth> worths_of(const NodeGraph& graph) {
    const auto n = graph.nodes();
    const auto lengths = path_lengths(graph);
    std::vector<Worth> worths(n, Worth{});
    for (std::uint32_t i = 0; i < n; ++i) {
        const int far = std::accumulate(lengths[i].begin(), lengths[i].end(), 0);
        worths[i][0] = static_cast<double>(graph.neighbours[i].size());
        worths[i][2] = far > 0 ? (n - 1.0) / far : 0;
        worths[i][3] = -*std::max_element(lengths[i].begin(), lengths[i].end());
        worths[i][index_place] = -static_cast<double>(i);
        add_betweenness(graph, i, worths);
    }
    return worths;
}

bool differ(double a, double b) {
    return std::abs(a - b) > 1e-9 * (1 + std::abs(a) + std::abs(b));
}

Nodes sorted(Nodes nodes) {
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

struct Choice {
    Worth worth{};
    Nodes nodes;

    /// Sets of one size: their sums stand for their means.
    bool better_than(const Choice& other, Mirror mirror) const {
        for (std::size_t i = 0; i < worth.size(); ++i)
            if (differ(worth[i], other.worth[i])) return worth[i] > other.worth[i];
        return mirror == Mirror::first && sorted(nodes) < sorted(other.nodes);
    }
};

/// The best set of every size.
using BySize = std::map<std::size_t, Choice>;

/// Independent sets of induced subgraphs, the best of every size: a node is in or out, and what falls apart is solved on its
/// own. Sums grow alike on both sides of a comparison, so the best of a whole is made of the bests of its parts.
class SetSearch {
  public:
    SetSearch(const NodeGraph& graph, const std::vector<Worth>& worths, Mirror mirror)
        : graph_(graph), worths_(worths), mirror_(mirror) {}

    const BySize& best(const Nodes& nodes) {
        const auto known = memo_.find(nodes);
        if (known != memo_.end()) return known->second;
        return memo_[nodes] = solve(nodes);
    }

  private:
    void offer(BySize& to, Choice choice) const {
        const auto size = choice.nodes.size();
        const auto found = to.find(size);
        if (found == to.end() || choice.better_than(found->second, mirror_)) to[size] = std::move(choice);
    }

    Nodes neighbours_within(std::uint32_t node, const Nodes& nodes) const {
        Nodes out;
        const auto& near = graph_.neighbours[node];
        std::set_intersection(near.begin(), near.end(), nodes.begin(), nodes.end(), std::back_inserter(out));
        return out;
    }

    Nodes component(const Nodes& nodes) const {
        Nodes out{nodes[0]};
        for (std::size_t i = 0; i < out.size(); ++i)
            for (const auto next : neighbours_within(out[i], nodes))
                if (std::find(out.begin(), out.end(), next) == out.end()) out.push_back(next);
        std::sort(out.begin(), out.end());
        return out;
    }

    static Nodes without(const Nodes& nodes, const Nodes& gone) {
        Nodes out;
        std::set_difference(nodes.begin(), nodes.end(), gone.begin(), gone.end(), std::back_inserter(out));
        return out;
    }

    BySize joined(const BySize& a, const BySize& b) const {
        BySize out;
        for (const auto& [size_a, one] : a)
            for (const auto& [size_b, other] : b) {
                Choice both = one;
                for (std::size_t i = 0; i < both.worth.size(); ++i) both.worth[i] += other.worth[i];
                both.nodes.insert(both.nodes.end(), other.nodes.begin(), other.nodes.end());
                offer(out, std::move(both));
            }
        return out;
    }

    BySize solve(const Nodes& nodes) {
        if (nodes.empty()) return {{0, {}}};
        const auto part = component(nodes);
        if (part.size() < nodes.size()) {
            const BySize first = best(part);
            return joined(first, best(without(nodes, part)));
        }
        const auto widest = *std::max_element(nodes.begin(), nodes.end(), [&](auto a, auto b) {
            return neighbours_within(a, nodes).size() < neighbours_within(b, nodes).size();
        });
        BySize out = best(without(nodes, {widest}));
        Nodes gone = neighbours_within(widest, nodes);
        gone.insert(std::lower_bound(gone.begin(), gone.end(), widest), widest);
        for (auto& [size, choice] : joined({{1, {worths_[widest], {widest}}}}, best(without(nodes, gone))))
            offer(out, std::move(choice));
        return out;
    }

    const NodeGraph& graph_;
    const std::vector<Worth>& worths_;
    Mirror mirror_;
    std::map<Nodes, BySize> memo_;
};

/// Sets of different sizes: the degrees' sum, then means, then the size itself.
bool beats(const Choice& a, const Choice& b) {
    const auto size_a = static_cast<double>(a.nodes.size()), size_b = static_cast<double>(b.nodes.size());
    if (differ(a.worth[0], b.worth[0])) return a.worth[0] > b.worth[0];
    for (std::size_t i = 1; i < index_place; ++i)
        if (differ(a.worth[i] / size_a, b.worth[i] / size_b))
            return a.worth[i] / size_a > b.worth[i] / size_b;
    if (a.nodes.size() != b.nodes.size()) return a.nodes.size() < b.nodes.size();
    return a.worth[index_place] > b.worth[index_place];
}

}  // namespace

NodeGraph graph_of_tree(const std::vector<int>& parents) {
    NodeGraph graph{std::vector<Nodes>(parents.size())};
    for (std::size_t child = 0; child < parents.size(); ++child) {
        if (parents[child] < 0) continue;
        const auto parent = static_cast<std::size_t>(parents[child]);
        graph.neighbours[child].push_back(static_cast<std::uint32_t>(parent));
        graph.neighbours[parent].push_back(static_cast<std::uint32_t>(child));
    }
    for (auto& near : graph.neighbours) std::sort(near.begin(), near.end());
    return graph;
}

std::vector<std::vector<int>> path_lengths(const NodeGraph& graph) {
    const auto n = graph.nodes();
    std::vector<std::vector<int>> lengths(n, std::vector<int>(n, -1));
    for (std::uint32_t from = 0; from < n; ++from) {
        Nodes queue{from};
        lengths[from][from] = 0;
        for (std::size_t i = 0; i < queue.size(); ++i)
            for (const auto next : graph.neighbours[queue[i]]) {
                if (lengths[from][next] >= 0) continue;
                lengths[from][next] = lengths[from][queue[i]] + 1;
                queue.push_back(next);
            }
    }
    return lengths;
}

std::vector<std::uint32_t> kept_nodes(const NodeGraph& graph, Mirror mirror) {
    if (graph.nodes() < 2) return all_nodes(graph);
    const auto worths = worths_of(graph);
    SetSearch search(graph, worths, mirror);
    // Degrees are positive, so the set of the largest degree sum can take no further node: it is maximal.
    const Choice* chosen = nullptr;
    for (const auto& [size, choice] : search.best(all_nodes(graph)))
        if (size > 0 && (!chosen || beats(choice, *chosen))) chosen = &choice;
    return sorted(chosen->nodes);
}

NodeGraph coarsened(const NodeGraph& graph, const std::vector<std::uint32_t>& kept) {
    constexpr int reach = 3;
    const auto lengths = path_lengths(graph);
    NodeGraph out{std::vector<Nodes>(kept.size())};
    for (std::size_t a = 0; a < kept.size(); ++a)
        for (std::size_t b = 0; b < kept.size(); ++b) {
            const int length = lengths[kept[a]][kept[b]];
            if (length > 0 && length <= reach) out.neighbours[a].push_back(static_cast<std::uint32_t>(b));
        }
    return out;
}

bool HopMatrix::feeds(std::size_t hop, std::size_t input) const {
    for (std::size_t output = 0; output < outputs; ++output)
        if (at(hop, output, input) != 0) return true;
    return false;
}

HopMatrix hop_matrix(const NodeGraph& graph, const std::vector<std::uint32_t>& kept) {
    const auto lengths = path_lengths(graph);
    HopMatrix matrix;
    matrix.outputs = static_cast<std::uint32_t>(kept.size());
    matrix.inputs = graph.nodes();
    for (std::uint32_t hop = 0; hop < matrix.hops; ++hop) {
        const auto here = [&](std::size_t row, std::size_t column) {
            return lengths[kept[row]][column] == static_cast<int>(hop);
        };
        std::vector<int> rows(matrix.outputs, 0), columns(matrix.inputs, 0);
        for (std::size_t row = 0; row < matrix.outputs; ++row)
            for (std::size_t column = 0; column < matrix.inputs; ++column)
                if (here(row, column)) {
                    ++rows[row];
                    ++columns[column];
                }
        for (std::size_t row = 0; row < matrix.outputs; ++row)
            for (std::size_t column = 0; column < matrix.inputs; ++column)
                matrix.values.push_back(here(row, column) ? 1 / std::sqrt(static_cast<float>(rows[row]) *
                                                                          static_cast<float>(columns[column]))
                                                          : 0);
    }
    return matrix;
}

HopMatrix radial_hop_matrix(const NodeGraph& graph, const std::vector<std::uint32_t>& kept) {
    const auto worths = worths_of(graph);
    std::uint32_t centre = 0;
    for (std::uint32_t i = 1; i < graph.nodes(); ++i)
        if (differ(worths[i][1], worths[centre][1]) && worths[i][1] > worths[centre][1]) centre = i;
    const auto far = path_lengths(graph)[centre];
    auto matrix = hop_matrix(graph, kept);
    const auto size = std::size_t{matrix.outputs} * matrix.inputs;
    matrix.hops = 3;
    matrix.values.resize(3 * size, 0);
    for (std::size_t row = 0; row < matrix.outputs; ++row)
        for (std::size_t column = 0; column < matrix.inputs; ++column) {
            const auto output = kept[row];
            const bool inward = std::pair(far[column], column) < std::pair(far[output], std::size_t{output});
            const auto at = size + row * matrix.inputs + column;
            if (!inward) std::swap(matrix.values[at], matrix.values[at + size]);
        }
    return matrix;
}

HopMatrix transposed(const HopMatrix& matrix) {
    HopMatrix out{matrix.hops, matrix.inputs, matrix.outputs, {}};
    for (std::size_t hop = 0; hop < matrix.hops; ++hop)
        for (std::size_t output = 0; output < out.outputs; ++output)
            for (std::size_t input = 0; input < out.inputs; ++input)
                out.values.push_back(matrix.at(hop, input, output));
    return out;
}

SkeletonLevels skeleton_levels(const std::vector<int>& parents, Mirror mirror) {
    SkeletonLevels levels;
    levels.fine = graph_of_tree(parents);
    levels.middle_kept = kept_nodes(levels.fine, mirror);
    levels.middle = coarsened(levels.fine, levels.middle_kept);
    levels.coarse_kept = kept_nodes(levels.middle, mirror);
    levels.coarse = coarsened(levels.middle, levels.coarse_kept);
    return levels;
}

std::vector<std::uint32_t> all_nodes(const NodeGraph& graph) {
    Nodes nodes(graph.nodes());
    std::iota(nodes.begin(), nodes.end(), 0U);
    return nodes;
}

}  // namespace actformer::model
