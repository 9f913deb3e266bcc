#include "eval/scoring/metric_value.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/error.hpp"

using namespace actformer;

TEST(MetricValues, AreThereForEveryMetricAndNoOther) {
    std::vector<std::string_view> declared, fetched;
    for (const auto& metric : eval::metrics()) declared.push_back(metric.name);
    for (const auto& value : eval::metric_values()) fetched.push_back(value.name);
    EXPECT_EQ(fetched, declared);
}

TEST(MetricValues, ComeFromOnePlaceEach) {
    for (const auto& value : eval::metric_values())
        EXPECT_NE(value.of != nullptr, value.of_motion != nullptr) << value.name;
}

TEST(MetricValues, RefuseAMetricThatNobodyMeasures) {
    EXPECT_THROW(eval::value_of({}, {"beauty", "beauty", "", 1, eval::Direction::higher}), Error);
}
