#include "eval/metrics/metric.hpp"

#include <gtest/gtest.h>

#include <set>

#include "eval/scoring/score_report.hpp"

using namespace actformer::eval;

TEST(Metrics, HaveNamesOfTheirOwnAndValues) {
    std::set<std::string_view> names;
    Score score;
    score.confusion = Confusion(2);
    score.confusion->add(1, 1);
    score.fid = Distances{3, 4, {}, {}};
    score.fid_groups = Distances{5, 6, {}, {}};
    score.diversity = 7;
    score.multimodality = 8;
    std::vector<double> values;
    for (const auto& metric : metrics()) {
        names.insert(metric.name);
        EXPECT_EQ(find_metric(metric.name), &metric);
        ASSERT_TRUE(value_of(score, metric)) << metric.name;
        values.push_back(*value_of(score, metric));
    }
    EXPECT_EQ(names.size(), metrics().size());
    EXPECT_EQ(values, (std::vector<double>{1, 4, 3, 6, 5, 7, 8}));
    EXPECT_EQ(find_metric("fid"), nullptr);
    const Score nothing;
    for (const auto* name : {"accuracy", "fid_mean", "fida_mean", "fida_whole", "diversity", "multimodality"})
        EXPECT_FALSE(value_of(nothing, *find_metric(name))) << name;
}

TEST(Metrics, SayWhichWayIsBetter) {
    EXPECT_EQ(find_metric("accuracy")->direction, Direction::higher);
    EXPECT_EQ(find_metric("accuracy")->scale, 100) << "shares are printed in per cent";
    EXPECT_EQ(find_metric("fid_whole")->direction, Direction::lower);
    EXPECT_EQ(find_metric("diversity")->direction, Direction::nearest_real);
}
