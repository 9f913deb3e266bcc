#include "eval/stgcn/graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ingest/dataset/topology.hpp"

using actformer::eval::partition;

TEST(Partition, PartsAChainByTheDistanceFromItsCentre) {
    // 0 - 1 - 2 - 3 with the centre 1
    const auto parts = partition({{-1, 0, 1, 2}, 1});
    const auto at = [&](int part, int v, int w) { return parts[part][v * 4 + w]; };
    EXPECT_EQ(at(0, 0, 0), 0.5);
    EXPECT_EQ(at(0, 1, 1), 1.0 / 3) << "columns are divided by their degree";
    EXPECT_EQ(at(1, 0, 1), 1.0 / 3) << "0 is farther from the centre than 1 is";
    EXPECT_EQ(at(2, 1, 0), 0.5) << "1 is closer";
    EXPECT_EQ(at(1, 3, 2), 1.0 / 3);
    EXPECT_EQ(at(2, 2, 3), 0.5);
    EXPECT_EQ(at(1, 2, 3), 0);
}

TEST(Partition, CountsAllBeyondOneHopAsEqual) {
    // 0 - 1 - 2 - 3 with the centre 0: 2 and 3 are both beyond one hop
    const auto parts = partition({{-1, 0, 1, 2}, 0});
    EXPECT_EQ(parts[1][2 * 4 + 3], 0.5);
    EXPECT_EQ(parts[1][3 * 4 + 2], 1.0 / 3);
    EXPECT_EQ(parts[2][1 * 4 + 2], 1.0 / 3);
}

TEST(Partition, FollowsNtusSpineAndHands) {
    const auto parts = partition(actformer::eval::ntu_graph());
    const auto at = [&](int part, int v, int w) { return parts[part][v * 25 + w]; };
    EXPECT_GT(at(1, 1, 20), 0) << "the spine is farther from the centre than the centre";
    EXPECT_GT(at(2, 20, 1), 0);
    EXPECT_GT(at(1, 22, 21), 0) << "a hand's tip hangs from its thumb; both are beyond one hop";
    EXPECT_GT(at(1, 21, 22), 0);
    std::ptrdiff_t edges = 0;
    for (const auto& part : parts)
        edges += std::count_if(part.begin(), part.end(), [](double v) { return v > 0; });
    EXPECT_EQ(edges, 25 + 2 * 24);
}

TEST(Partition, OfAnotherSkeletonIsItsOwnTreeAboutItsRoot) {
    using actformer::eval::recogniser_graph;
    EXPECT_EQ(recogniser_graph({1, -1, 1}), (actformer::eval::Graph{{1, -1, 1}, 1}));
    EXPECT_EQ(recogniser_graph(actformer::ingest::ntu25().parents), actformer::eval::ntu_graph());
}

TEST(Partition, SharesOutEveryNeighbourhoodOnce) {
    const auto parts = partition(actformer::eval::ntu_graph());
    for (std::size_t w = 0; w < 25; ++w) {
        double sum = 0;
        for (const auto& part : parts)
            for (std::size_t v = 0; v < 25; ++v) sum += part[v * 25 + w];
        EXPECT_NEAR(sum, 1, 1e-15);
    }
}
