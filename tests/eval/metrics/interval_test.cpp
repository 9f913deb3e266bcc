#include "eval/metrics/interval.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace actformer;

TEST(Interval, TakesStudentsQuantiles) {
    // from printed tables
    EXPECT_NEAR(eval::student_95(1), 12.706, 5e-4);
    EXPECT_NEAR(eval::student_95(2), 4.303, 5e-4);
    EXPECT_NEAR(eval::student_95(3), 3.182, 5e-4);
    EXPECT_NEAR(eval::student_95(4), 2.776, 5e-4);
    EXPECT_NEAR(eval::student_95(19), 2.093, 5e-4);
    EXPECT_NEAR(eval::student_95(120), 1.980, 5e-4);
    EXPECT_NEAR(eval::student_95(100'001), 1.960, 5e-4);
}

TEST(Interval, OfADifferenceIsWelchs) {
    // SciPy 1.10: t.ppf(0.975, 4.655) * sqrt(var(a) / 4 + var(b) / 3), the degrees of freedom by Welch and Satterthwaite
    const std::vector<double> a{1, 2, 3, 6}, b{5, 7, 9};
    const auto got = eval::difference(a, b);
    EXPECT_EQ(got.mean, 4);
    EXPECT_NEAR(*got.half_width, 4.156693, 1e-5);
    EXPECT_FALSE(eval::difference(a, std::vector<double>{5}).half_width);
    const std::vector<double> same{5, 5};
    EXPECT_EQ(eval::difference(same, same).half_width, 0);
}

TEST(Interval, OfPairsIsThatOfTheirDifferences) {
    const std::vector<double> a{1, 5, 9}, b{2, 7, 10};  // differences 1 2 1: mean 4 / 3, s^2 = 1 / 3
    const auto got = eval::paired_difference(a, b);
    EXPECT_NEAR(got.mean, 4.0 / 3, 1e-12);
    EXPECT_NEAR(*got.half_width, 4.30265 * std::sqrt(1.0 / 3 / 3), 1e-4);
    EXPECT_GT(*eval::difference(a, b).half_width, 4)
        << "where they do not belong together they vary by themselves";
}

TEST(Interval, OfRepeats) {
    const std::vector<double> values{1, 2, 3, 6};  // s^2 = 14 / 3
    const auto got = eval::interval(values);
    EXPECT_EQ(got.mean, 3);
    EXPECT_NEAR(*got.half_width, 3.18245 * std::sqrt(14.0 / 3 / 4), 1e-4);
    EXPECT_NEAR(*eval::normal_interval(values).half_width, 1.96 * std::sqrt(14.0 / 3 / 4), 1e-12);
    EXPECT_FALSE(eval::interval(std::vector<double>{5}).half_width)
        << "one value tells nothing of its spread";
    EXPECT_EQ(eval::interval(std::vector<double>{5, 5, 5}).half_width, 0);
}
