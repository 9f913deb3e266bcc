#include "ingest/formats/ntu/bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace actformer::ingest;
using Indices = std::vector<std::size_t>;

namespace {

/// Seen in frames 0 .. frames - 1; its root swings by `swing` metres and its limbs are fixed.
Body swinging(std::uint32_t frames, double swing) {
    Body body;
    for (std::uint32_t t = 0; t < frames; ++t) {
        body.times.push_back(t);
        body.limbs.resize(body.limbs.size() + ntu_joints * 3, 0.1F);
        body.limbs[body.limbs.size() - ntu_joints * 3] = static_cast<float>(1 + swing * std::sin(t));
    }
    return body;
}

}  // namespace

TEST(Bodies, MotionIsTheVarianceOfPositions) {
    EXPECT_NEAR(motion_of(swinging(50, 0)), 0, 1e-12);
    // 25 joints move with the root along x; the mean of sin^2 over whole periods is a half, over 44 = 7 * 2 pi frames nearly so.
    EXPECT_NEAR(motion_of(swinging(44, 0.2)), 25 * 0.5 * 0.2 * 0.2, 0.01);
    // An elbow that moves takes wrist, hand, tip and thumb along: joints 5 6 7 21 22.
    auto arm = swinging(2, 0);
    arm.limbs[ntu_joints * 3 + 5 * 3 + 1] += 0.5F;
    EXPECT_NEAR(motion_of(arm), 5 * 0.25 * 0.25, 1e-6) << "two values 0.5 apart have variance 0.25^2";
}

TEST(Bodies, ThatDoNotMoveAreTold) {
    EXPECT_TRUE(stands_still(swinging(20, 0)));
    EXPECT_TRUE(stands_still(swinging(1, 0.1)));
    EXPECT_FALSE(stands_still(swinging(20, 0.1)));
    auto nods = swinging(20, 0);
    nods.limbs.back() += 0.01F;
    EXPECT_FALSE(stands_still(nods));
}

TEST(Bodies, ByFramesTheMostSeenComeFirstAndTiesGoToTheFirst) {
    const std::vector<Body> bodies{swinging(20, 1), swinging(30, 0), swinging(20, 2), swinging(30, 0)};
    EXPECT_EQ(preferred(bodies, 1, BodyRule::frames), (Indices{1}));
    EXPECT_EQ(preferred(bodies, 3, BodyRule::frames), (Indices{1, 3, 0}));
    EXPECT_EQ(preferred(bodies, 9, BodyRule::frames).size(), 4U);
}

TEST(Bodies, ByMotionAGhostLosesThoughSeenLonger) {
    const auto ghost = swinging(60, 0), actor = swinging(55, 0.1), other = swinging(40, 0.2);
    EXPECT_EQ(preferred({ghost, actor}, 1, BodyRule::motion), (Indices{1}));
    EXPECT_EQ(preferred({ghost, actor, other}, 2, BodyRule::motion), (Indices{2, 1})) << "two persons";
    EXPECT_EQ(preferred({ghost}, 1, BodyRule::motion), (Indices{0})) << "who stands still is there too";
}

TEST(Bodies, ByMotionNoiseOfAFewFramesComesLast) {
    EXPECT_EQ(preferred({swinging(11, 5), swinging(12, 0.01)}, 2, BodyRule::motion), (Indices{1, 0}));
    EXPECT_EQ(preferred({swinging(5, 1), swinging(6, 2)}, 1, BodyRule::motion), (Indices{1}));
}
