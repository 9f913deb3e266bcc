#include "ingest/smpl/smpl24.hpp"

#include <gtest/gtest.h>

using namespace actformer::ingest;

TEST(Smpl24, IsATreeWhoseParentsComeFirst) {
    EXPECT_NO_THROW(smpl24().check("smpl24"));
    for (std::size_t j = 1; j < smpl_joints; ++j) EXPECT_LT(smpl24_parents[j], static_cast<int>(j));
}

TEST(Smpl24, GenericSkeletonStandsUprightAndSymmetric) {
    const auto skeleton = generic_skeleton();
    EXPECT_EQ(skeleton.source, "generic");
    ASSERT_EQ(skeleton.offsets.size(), smpl_joints * 3);
    const auto& names = smpl24().names;
    std::vector<double> at(smpl_joints * 3);
    for (std::size_t j = 0; j < smpl_joints; ++j)
        for (std::size_t d = 0; d < 3; ++d)
            at[3 * j + d] = skeleton.offsets[3 * j + d] +
                            (j == 0 ? 0 : at[3 * static_cast<std::size_t>(smpl24_parents[j]) + d]);
    for (std::size_t j = 0; j < smpl_joints; ++j) {
        if (!names[j].starts_with("left ")) continue;
        const auto other = static_cast<std::size_t>(
            std::find(names.begin(), names.end(), "right " + names[j].substr(5)) - names.begin());
        ASSERT_LT(other, smpl_joints) << names[j];
        EXPECT_GT(at[3 * j], 0) << names[j];  // left is +x
        EXPECT_EQ(at[3 * j], -at[3 * other]);
        EXPECT_EQ(at[3 * j + 1], at[3 * other + 1]);
        EXPECT_EQ(at[3 * j + 2], at[3 * other + 2]);
    }
    // An adult: from the feet to the head's joint, and from hand to hand.
    EXPECT_NEAR(at[3 * 15 + 1] - at[3 * 10 + 1], 1.4, 0.1);
    EXPECT_NEAR(at[3 * 22] - at[3 * 23], 1.5, 0.1);
}
