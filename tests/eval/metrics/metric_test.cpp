#include "eval/metrics/metric.hpp"

#include <gtest/gtest.h>

#include <set>

#include "eval/scoring/score_report.hpp"

using namespace actformer::eval;

TEST(Metrics, HaveNamesOfTheirOwnAndValues) {
    std::set<std::string_view> names;
    Score score;
    score.accuracy = 1;
    score.fid = Distances{3, 4, {}, {}};
    score.fid_groups = Distances{5, 6, {}, {}};
    score.fid_mean_infinity = 7;
    score.fid_whole_infinity = 8;
    score.kid_mean = 9;
    score.kid_whole = 10;
    score.diversity = 11;
    score.multimodality = 12;
    score.motion = {13, 14, 15, 16, 17};
    std::vector<double> values;
    for (const auto& metric : metrics()) {
        names.insert(metric.name);
        EXPECT_EQ(find_metric(metric.name), &metric);
        EXPECT_EQ(find_metric(metric.heading), &metric);
        ASSERT_TRUE(value_of(score, metric)) << metric.name;
        values.push_back(*value_of(score, metric));
    }
    EXPECT_EQ(names.size(), metrics().size());
    EXPECT_EQ(values, (std::vector<double>{1, 4, 3, 6, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17}));
    EXPECT_EQ(find_metric("fid"), nullptr);
    const Score nothing;
    for (const auto& metric : metrics()) EXPECT_FALSE(value_of(nothing, metric)) << metric.name;
}

TEST(Metrics, HaveTheirUnitsInHeadings) {
    EXPECT_EQ(heading_with_unit(*find_metric("accuracy")), "accuracy %");
    EXPECT_EQ(heading_with_unit(*find_metric("fid_mean")), "FIDm");
    EXPECT_EQ(heading_with_unit(*find_metric("foot_sliding")), "foot sliding m/s");
}

TEST(Metrics, SayWhichWayIsBetter) {
    EXPECT_EQ(find_metric("accuracy")->direction, Direction::higher);
    EXPECT_EQ(find_metric("accuracy")->scale, 100) << "shares are printed in per cent";
    EXPECT_EQ(find_metric("fid_whole")->direction, Direction::lower);
    EXPECT_EQ(find_metric("diversity")->direction, Direction::nearest_real);
}
