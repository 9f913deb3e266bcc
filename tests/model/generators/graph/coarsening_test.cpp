// Coarsening: NTU's skeleton by its published levels, small trees against all their independent sets.
#include "model/generators/graph/coarsening.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "ingest/dataset/topology.hpp"

using namespace actformer::model;

namespace {

using Nodes = std::vector<std::uint32_t>;

/// Betweenness from the definition: over pairs of other nodes, the share of shortest paths that pass.
std::vector<double> betweenness(const NodeGraph& graph) {
    const auto lengths = path_lengths(graph);
    const auto n = graph.nodes();
    std::vector<std::vector<double>> paths(n, std::vector<double>(n, 0));
    for (std::uint32_t s = 0; s < n; ++s) {
        paths[s][s] = 1;
        for (int length = 1; length < static_cast<int>(n); ++length)
            for (std::uint32_t v = 0; v < n; ++v)
                if (lengths[s][v] == length)
                    for (const auto u : graph.neighbours[v])
                        if (lengths[s][u] == length - 1) paths[s][v] += paths[s][u];
    }
    std::vector<double> out(n, 0);
    for (std::uint32_t v = 0; v < n; ++v)
        for (std::uint32_t s = 0; s < n; ++s)
            for (std::uint32_t t = 0; t < n; ++t)
                if (s != v && t != v && s != t && lengths[s][v] + lengths[v][t] == lengths[s][t])
                    out[v] += paths[s][v] * paths[v][t] / paths[s][t];
    return out;
}

/// What is compared, the larger the better.
std::array<double, 6> worth(const NodeGraph& graph, const Nodes& set, const std::vector<double>& between) {
    const auto lengths = path_lengths(graph);
    const auto size = static_cast<double>(set.size());
    std::array<double, 6> w{};
    for (const auto v : set) {
        w[0] += static_cast<double>(graph.neighbours[v].size());
        w[1] += between[v] / size;
        w[2] += (graph.nodes() - 1.0) / std::accumulate(lengths[v].begin(), lengths[v].end(), 0) / size;
        w[3] -= *std::max_element(lengths[v].begin(), lengths[v].end()) / size;
        w[5] -= v;
    }
    w[4] = -size;
    return w;
}

bool independent(const NodeGraph& graph, std::uint32_t set, std::uint32_t v) {
    for (const auto u : graph.neighbours[v])
        if ((set >> u & 1U) != 0) return false;
    return true;
}

/// By looking at every set of nodes.
Nodes best_of_all(const NodeGraph& graph) {
    const auto between = betweenness(graph);
    Nodes best;
    std::array<double, 6> top{};
    for (std::uint32_t set = 1; set < 1U << graph.nodes(); ++set) {
        bool good = true;
        Nodes nodes;
        for (std::uint32_t v = 0; v < graph.nodes() && good; ++v) {
            const bool in = (set >> v & 1U) != 0, free = independent(graph, set, v);
            good = in == free;  // independent, and maximal: whoever is out has a neighbour in
            if (in) nodes.push_back(v);
        }
        if (!good) continue;
        const auto now = worth(graph, nodes, between);
        bool better = best.empty();
        for (std::size_t i = 0; !better && i < now.size(); ++i) {
            if (std::abs(now[i] - top[i]) < 1e-9) continue;
            if (now[i] < top[i]) break;
            better = true;
        }
        if (!better) continue;
        best = nodes;
        top = now;
    }
    return best;
}

std::vector<int> random_tree(std::mt19937& random, int nodes) {
    std::vector<int> parents{-1};
    for (int i = 1; i < nodes; ++i) parents.push_back(static_cast<int>(random() % static_cast<unsigned>(i)));
    return parents;
}

}  // namespace

TEST(Coarsening, KeepsThePublishedJointsOfNtu) {
    const auto levels = skeleton_levels(actformer::ingest::ntu25().parents);
    EXPECT_EQ(levels.middle_kept, (Nodes{0, 3, 5, 7, 9, 11, 13, 15, 17, 19, 20}));
    Nodes coarse;
    for (const auto node : levels.coarse_kept) coarse.push_back(levels.middle_kept[node]);
    EXPECT_EQ(coarse, (Nodes{7, 11, 13, 17, 20}));
}

/// SMPL's 24 joints with the translation as a 25th node on the pelvis; igraph's measures give these sets.
TEST(Coarsening, KeepsTheTranslationOfSmpl) {
    const auto levels = skeleton_levels(
        {-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21, 0});
    EXPECT_EQ(levels.middle_kept, (Nodes{1, 2, 3, 7, 8, 9, 15, 16, 17, 20, 21, 24}));
    Nodes coarse;
    for (const auto node : levels.coarse_kept) coarse.push_back(levels.middle_kept[node]);
    // The left and the right of a body measure alike: {1, 8, 9, 20, 21} is the same set in a mirror.
    EXPECT_TRUE(coarse == (Nodes{1, 8, 9, 20, 21}) || coarse == (Nodes{2, 7, 9, 20, 21})) << coarse[0];
}

TEST(Coarsening, ChoosesTheBestOfAllSets) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 60; ++trial) {
        const auto tree = graph_of_tree(random_tree(random, 2 + trial % 11));
        const auto kept = kept_nodes(tree);
        EXPECT_EQ(kept, best_of_all(tree)) << trial;
        const auto coarse = coarsened(tree, kept);  // no tree any more
        if (coarse.nodes() < 2) continue;
        EXPECT_EQ(kept_nodes(coarse), best_of_all(coarse)) << trial;
    }
}

TEST(Coarsening, JoinsKeptNodesUpToThreeHopsApart) {
    const auto path = graph_of_tree({-1, 0, 1, 2, 3, 4, 5, 6});
    const auto coarse = coarsened(path, {0, 3, 5, 7});
    EXPECT_EQ(coarse.neighbours, (std::vector<Nodes>{{1}, {0, 2}, {1, 3}, {2}}));
}

TEST(Coarsening, HopMatricesHaveTheirCountsUnderTheRoot) {
    // A star of four: node 0 in the middle. At one hop its row holds three, theirs one.
    const auto star = graph_of_tree({-1, 0, 0, 0});
    const auto all = hop_matrix(star, all_nodes(star));
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            EXPECT_FLOAT_EQ(all.at(0, i, j), i == j ? 1 : 0);
            EXPECT_FLOAT_EQ(all.at(1, i, j), (i == 0) != (j == 0) ? 1 / std::sqrt(3.0F) : 0);
        }
    const auto leaves = hop_matrix(star, {1, 2, 3});
    EXPECT_FALSE(leaves.feeds(0, 0));
    EXPECT_TRUE(leaves.feeds(1, 0));
    EXPECT_FALSE(leaves.feeds(1, 2));
    EXPECT_FLOAT_EQ(transposed(leaves).at(1, 0, 2), leaves.at(1, 2, 0));
}

TEST(Coarsening, RadialHopsPartNeighboursByTheirDistanceToTheCentre) {
    // A chain of five, its centre 2: node 1 is nearer than 0, node 3 nearer than 4.
    const auto chain = graph_of_tree({-1, 0, 1, 2, 3});
    const auto whole = hop_matrix(chain, all_nodes(chain)),
               parts = radial_hop_matrix(chain, all_nodes(chain));
    ASSERT_EQ(parts.hops, 3U);
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 5; ++j) {
            EXPECT_EQ(parts.at(0, i, j), whole.at(0, i, j));
            EXPECT_EQ(parts.at(1, i, j) + parts.at(2, i, j), whole.at(1, i, j));
            if (whole.at(1, i, j) == 0) continue;
            const bool inward = std::abs(static_cast<int>(j) - 2) < std::abs(static_cast<int>(i) - 2);
            EXPECT_EQ(parts.at(inward ? 2 : 1, i, j), 0) << i << " from " << j;
        }
    // Two nodes measure alike: the smaller index is the centre.
    const auto pair = graph_of_tree({-1, 0});
    const auto two = radial_hop_matrix(pair, all_nodes(pair));
    EXPECT_GT(two.at(1, 1, 0), 0) << "from the centre";
    EXPECT_GT(two.at(2, 0, 1), 0);
}

TEST(Coarsening, TakesSkeletonsWithHands) {
    // A spine, two arms of four joints and five fingers of four on each: many sets are equally good.
    std::vector<int> parents{-1, 0, 1, 2, 3};
    for (int arm = 0; arm < 2; ++arm) {
        int at = 4;
        for (int i = 0; i < 4; ++i, at = static_cast<int>(parents.size()) - 1) parents.push_back(at);
        for (int finger = 0; finger < 5; ++finger) {
            int joint = at;
            for (int i = 0; i < 4; ++i, joint = static_cast<int>(parents.size()) - 1)
                parents.push_back(joint);
        }
    }
    const auto levels = skeleton_levels(parents);
    EXPECT_EQ(levels.fine.nodes(), 53U);
    EXPECT_LT(levels.middle.nodes(), 30U);
    EXPECT_LT(levels.coarse.nodes(), levels.middle.nodes());
    // Every node is kept or next to one that is.
    std::vector<char> reached(53, 0);
    for (const auto node : levels.middle_kept) {
        reached[node] = 1;
        for (const auto next : levels.fine.neighbours[node]) reached[next] = 1;
    }
    EXPECT_EQ(std::count(reached.begin(), reached.end(), 1), 53);
}

TEST(Coarsening, OneJointIsItsOwnCoarsening) {
    const auto levels = skeleton_levels({-1});
    EXPECT_EQ(levels.coarse_kept, Nodes{0});
}
