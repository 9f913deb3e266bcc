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
