#include "reports/figures/figure.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/reports/pictures/made_figures.hpp"

namespace actformer::reports {
namespace {

using testing::error_of;
using testing::walkers;

std::string fault(const Figure& figure) {
    return error_of([&] { check(figure); });
}

TEST(Figure, SoundOnesPass) {
    EXPECT_EQ(fault(walkers(1, 1)), "");
    EXPECT_EQ(fault(walkers(3, 10)), "");
}

TEST(Figure, SaysWhereAJointIsNotANumber) {
    auto figure = walkers(2, 5);
    figure.joints[((3 * 2 + 1) * 25 + 11) * 3 + 2] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(fault(figure).find("frame 3, person 1: right hand"), std::string::npos) << fault(figure);
    figure.seen.assign(10, 1);
    figure.seen[3 * 2 + 1] = 0;  // nobody looks at a body that is not there
    EXPECT_EQ(fault(figure), "");
}

TEST(Figure, RefusesEndlessDistances) {
    auto figure = walkers(1, 2);
    figure.joints[5] = std::numeric_limits<float>::infinity();
    EXPECT_NE(fault(figure).find("cannot be drawn"), std::string::npos);
    figure.joints[5] = 1e30F;
    EXPECT_NE(fault(figure).find("cannot be drawn"), std::string::npos);
}

TEST(Figure, RefusesNothingToDraw) {
    auto figure = walkers(1, 3);
    figure.seen.assign(3, 0);
    EXPECT_NE(fault(figure).find("shows nobody"), std::string::npos);
    figure = walkers(1, 0);
    EXPECT_NE(fault(figure).find("no frames"), std::string::npos);
    figure = walkers(0, 3);
    EXPECT_NE(fault(figure).find("no persons"), std::string::npos);
}

TEST(Figure, RefusesACrowd) {
    Figure figure = walkers(1, 1);
    figure.persons = 1000;
    EXPECT_NE(fault(figure).find("1000 persons; at most 64"), std::string::npos) << fault(figure);
}

TEST(Figure, RefusesSizesThatDisagree) {
    auto figure = walkers(1, 4);
    figure.joints.pop_back();
    EXPECT_NE(fault(figure).find("299 numbers"), std::string::npos) << fault(figure);
    figure = walkers(1, 4);
    figure.seen.assign(3, 1);
    EXPECT_NE(fault(figure).find("3 visibility flags"), std::string::npos);
    figure.seen.clear();
    figure.fps = 0;
    EXPECT_NE(fault(figure).find("frames a second"), std::string::npos);
}

TEST(Figure, ComesFromLimbs) {
    ingest::Motion motion{"clip", 2, 1, 2, 3, {0, 1, 0, 0, 1, 0, 5, 1, 0, 1, 0, 0}};
    const ingest::Topology topology{{"root", "tip"}, {-1, 0}};
    const auto figure = figure_of(motion, {{}, topology, {0, 0.5F}, {}}, 25, "two joints");
    EXPECT_FLOAT_EQ(figure.at(0, 0, 1)[1], 1.5F);
    EXPECT_FLOAT_EQ(figure.at(1, 0, 1)[0], 5.5F);
    EXPECT_DOUBLE_EQ(figure.seconds(), 0.08);

    EXPECT_NE(error_of([&] {
                  figure_of(motion, {{}, topology, {0.5F}, {}}, 25, "");
              }).find("1 limb lengths"),
              std::string::npos);
    EXPECT_NE(error_of([&] {
                  figure_of(motion, {{}, ingest::ntu25(), {}, {}}, 25, "");
              }).find("2 nodes"),
              std::string::npos);
}

TEST(Figure, UsualLengthsFitTheSkeleton) {
    const auto adult = usual_bone_lengths(ingest::ntu25());
    ASSERT_EQ(adult.size(), 25U);
    EXPECT_FLOAT_EQ(adult[5], adult[9]);  // both sides alike
    EXPECT_GT(adult[13], adult[6]);       // thighs are longer than forearms
    EXPECT_EQ(usual_bone_lengths({{"a", "b", "c"}, {-1, 0, 1}}), (std::vector<float>{0, 0.2F, 0.2F}));
}

}  // namespace
}  // namespace actformer::reports
