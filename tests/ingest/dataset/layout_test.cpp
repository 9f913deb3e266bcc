// The orders of a motion's axes, against places worked out by hand.
#include "ingest/dataset/layout.hpp"

#include <gtest/gtest.h>

#include <numeric>

using namespace actformer::ingest;

namespace {

/// Every number tells its own place: frame, person, node, number as digits.
Motion counted() {
    Motion motion{"", 4, 2, 5, 3, {}};
    for (int t = 0; t < 4; ++t)
        for (int p = 0; p < 2; ++p)
            for (int k = 0; k < 5; ++k)
                for (int d = 0; d < 3; ++d)
                    motion.values.push_back(static_cast<float>(1000 * t + 100 * p + 10 * k + d));
    return motion;
}

}  // namespace

TEST(Layout, NetworksHaveChannelsOfPersonsThenFramesThenNodes) {
    const auto values = channels_first(counted());
    ASSERT_EQ(values.size(), 120U);
    for (std::size_t p = 0; p < 2; ++p)
        for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t t = 0; t < 4; ++t)
                for (std::size_t k = 0; k < 5; ++k)
                    EXPECT_EQ(values[((p * 3 + d) * 4 + t) * 5 + k],
                              static_cast<float>(1000 * t + 100 * p + 10 * k + d));
}

TEST(Layout, ComesBack) {
    auto motion = counted();
    const auto values = channels_first(motion);
    motion.values.clear();
    take_channels_first(values, motion);
    EXPECT_EQ(motion.values, counted().values);
    EXPECT_EQ(with_last_axes_swapped(with_last_axes_swapped(values, 6, 4, 5), 6, 5, 4), values);
}

TEST(Layout, FilesHaveFramesLast) {
    std::vector<float> values(6);
    std::iota(values.begin(), values.end(), 0.0F);
    EXPECT_EQ(with_last_axes_swapped(values, 1, 2, 3), (std::vector<float>{0, 3, 1, 4, 2, 5}));
    EXPECT_TRUE(with_last_axes_swapped({}, 0, 2, 3).empty());
}
