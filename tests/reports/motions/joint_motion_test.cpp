#include "reports/motions/joint_motion.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/reports/motions/made_motions.hpp"

namespace actformer::reports {
namespace {

using testing::error_of;
using testing::walkers;

std::string fault(const JointMotion& motion) {
    return error_of([&] { check(motion); });
}

TEST(JointMotion, SoundOnesPass) {
    EXPECT_EQ(fault(walkers(1, 1)), "");
    EXPECT_EQ(fault(walkers(3, 10)), "");
}

TEST(JointMotion, SaysWhereAJointIsNotANumber) {
    auto motion = walkers(2, 5);
    motion.joints[((3 * 2 + 1) * 25 + 11) * 3 + 2] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(fault(motion).find("frame 3, person 1: right hand"), std::string::npos) << fault(motion);
    motion.seen.assign(10, 1);
    motion.seen[3 * 2 + 1] = 0;  // nobody looks at a body that is not there
    EXPECT_EQ(fault(motion), "");
}

TEST(JointMotion, RefusesEndlessDistances) {
    auto motion = walkers(1, 2);
    motion.joints[5] = std::numeric_limits<float>::infinity();
    EXPECT_NE(fault(motion).find("cannot be drawn"), std::string::npos);
    motion.joints[5] = 1e30F;
    EXPECT_NE(fault(motion).find("cannot be drawn"), std::string::npos);
}

TEST(JointMotion, RefusesNothingToDraw) {
    auto motion = walkers(1, 3);
    motion.seen.assign(3, 0);
    EXPECT_NE(fault(motion).find("shows nobody"), std::string::npos);
    motion = walkers(1, 0);
    EXPECT_NE(fault(motion).find("no frames"), std::string::npos);
    motion = walkers(0, 3);
    EXPECT_NE(fault(motion).find("no persons"), std::string::npos);
}

TEST(JointMotion, RefusesACrowd) {
    JointMotion motion = walkers(1, 1);
    motion.persons = 1000;
    EXPECT_NE(fault(motion).find("1000 persons; at most 64"), std::string::npos) << fault(motion);
}

TEST(JointMotion, RefusesSizesThatDisagree) {
    auto motion = walkers(1, 4);
    motion.joints.pop_back();
    EXPECT_NE(fault(motion).find("299 numbers"), std::string::npos) << fault(motion);
    motion = walkers(1, 4);
    motion.seen.assign(3, 1);
    EXPECT_NE(fault(motion).find("3 visibility flags"), std::string::npos);
    motion.seen.clear();
    motion.fps = 0;
    EXPECT_NE(fault(motion).find("frames a second"), std::string::npos);
}

TEST(JointMotion, ComesFromLimbs) {
    ingest::Motion motion{"clip", 2, 1, 2, 3, {0, 1, 0, 0, 1, 0, 5, 1, 0, 1, 0, 0}};
    const ingest::Topology topology{{"root", "tip"}, {-1, 0}};
    const auto drawn = joint_motion(motion, {{}, topology, {0, 0.5F}, {}}, 25, "two joints");
    EXPECT_FLOAT_EQ(drawn.at(0, 0, 1)[1], 1.5F);
    EXPECT_FLOAT_EQ(drawn.at(1, 0, 1)[0], 5.5F);
    EXPECT_DOUBLE_EQ(drawn.seconds(), 0.08);

    EXPECT_NE(error_of([&] {
                  joint_motion(motion, {{}, topology, {0.5F}, {}}, 25, "");
              }).find("1 limb lengths"),
              std::string::npos);
    EXPECT_NE(error_of([&] {
                  joint_motion(motion, {{}, ingest::ntu25(), {}, {}}, 25, "");
              }).find("2 nodes"),
              std::string::npos);
}

TEST(JointMotion, UsualLengthsFitTheSkeleton) {
    const auto adult = ingest::usual_bone_lengths(ingest::ntu25());
    ASSERT_EQ(adult.size(), 25U);
    EXPECT_FLOAT_EQ(adult[5], adult[9]);  // both sides alike
    EXPECT_GT(adult[13], adult[6]);       // thighs are longer than forearms
    EXPECT_EQ(ingest::usual_bone_lengths({{"a", "b", "c"}, {-1, 0, 1}}), (std::vector<float>{0, 0.2F, 0.2F}));
}

}  // namespace
}  // namespace actformer::reports
