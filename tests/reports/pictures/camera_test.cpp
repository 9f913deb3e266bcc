#include "reports/pictures/camera.hpp"

#include <gtest/gtest.h>

#include "tests/reports/motions/made_motions.hpp"

namespace actformer::reports {
namespace {

using testing::error_of;
using testing::walkers;

const cv::Rect2d cell(10, 10, 200, 300);

cv::Vec3d joint(const JointMotion& motion, std::size_t t, std::size_t p, std::size_t j) {
    const float* x = motion.at(t, p, j);
    return {x[0], x[1], x[2]};
}

void expect_inside(const JointMotion& motion, const View& view) {
    const Framing framing(motion, view);
    for (std::size_t t = 0; t < motion.frames; ++t)
        for (std::size_t p = 0; p < motion.persons; ++p)
            for (std::size_t j = 0; j < motion.topology.joints(); ++j) {
                const auto seen = framing.camera(t, cell).project(joint(motion, t, p, j));
                ASSERT_TRUE(cell.contains(cv::Point2d(seen.x, seen.y)))
                    << t << " " << p << " " << j << ": " << seen.x << " " << seen.y;
            }
}

TEST(View, Names) {
    EXPECT_EQ(parse_view("front").azimuth, 0);
    EXPECT_EQ(parse_view("top").elevation, 90);
    EXPECT_TRUE(parse_view("orbit").orbit);
    EXPECT_EQ(parse_view("-30,12.5").azimuth, -30);
    EXPECT_EQ(parse_view("-30,12.5").elevation, 12.5);
    for (const char* wrong :
         {"", "up", "30", "30,", ",30", "30,91", "1e9,0", "nan,0", "0,nan", "30,15 ", "30;15"})
        EXPECT_NE(error_of([&] { parse_view(wrong); }).find("is no view"), std::string::npos) << wrong;
}

TEST(Framing, KeepsEveryJointInside) {
    for (const char* view : {"front", "side", "top", "orbit", "three-quarter", "200,-40", "0,0"}) {
        expect_inside(walkers(1, 40), parse_view(view));
        expect_inside(walkers(3, 20), parse_view(view));
    }
}

TEST(Framing, GoesAlongWithWhoTravels) {
    auto motion = walkers(1, 120);
    for (std::size_t i = 0; i < motion.joints.size(); i += 3)
        motion.joints[i] += static_cast<float>(i / 75) * 0.05F;  // 6 m to the side in 4 s
    const Framing still(walkers(1, 120), {}), moving(motion, {});
    EXPECT_FALSE(still.follows());
    EXPECT_TRUE(moving.follows());
    EXPECT_GT(moving.camera(0, cell).scale(), 0.6 * still.camera(0, cell).scale());
    expect_inside(motion, {});
}

TEST(Framing, OneLostJointDoesNotShrinkTheRest) {
    auto motion = walkers(1, 100);
    const auto scale = Framing(motion, {}).camera(0, cell).scale();
    motion.joints[(50 * 25 + 7) * 3] = 500;
    EXPECT_GT(Framing(motion, {}).camera(0, cell).scale(), 0.4 * scale);
}

TEST(Framing, FrontLooksIntoTheFace) {
    const auto motion = walkers(1, 10);  // faces +z, its left hand towards +x
    const auto camera = Framing(motion, parse_view("front")).camera(0, cell);
    const auto left = camera.project(joint(motion, 0, 0, 4)), right = camera.project(joint(motion, 0, 0, 8));
    EXPECT_GT(left.x, right.x + 20);  // as one sees another person's left hand: to the right
    EXPECT_GT(camera.project(joint(motion, 0, 0, 15)).nearness,
              camera.project(joint(motion, 0, 0, 14)).nearness);
    EXPECT_LT(camera.project(joint(motion, 0, 0, 3)).y,
              camera.project(joint(motion, 0, 0, 0)).y);  // heads are up
}

TEST(Framing, TurnsWithThePerson) {
    auto turned = walkers(1, 10);
    for (std::size_t i = 0; i < turned.joints.size(); i += 3)
        std::swap(turned.joints[i], turned.joints[i + 2]);
    for (std::size_t i = 0; i < turned.joints.size(); i += 3)
        turned.joints[i] *= -1;  // a quarter turn about the vertical
    const auto straight = walkers(1, 10);
    const auto a = Framing(straight, {}).camera(3, cell).project(joint(straight, 3, 0, 11));
    const auto b = Framing(turned, {}).camera(3, cell).project(joint(turned, 3, 0, 11));
    EXPECT_NEAR(a.x, b.x, 1e-3);
    EXPECT_NEAR(a.y, b.y, 1e-3);
}

TEST(Framing, TwoFaceToFaceAreSeenFromTheSide) {
    auto motion = walkers(2, 10);
    for (std::size_t t = 0; t < 10; ++t)
        for (std::size_t j = 0; j < 25; ++j) {
            float* second = &motion.joints[((t * 2 + 1) * 25 + j) * 3];
            second[0] = 1.2F - second[0];  // half a turn on the spot, then 1.5 m in front of the first
            second[2] = 1.5F - second[2];
        }
    const auto camera = Framing(motion, parse_view("front")).camera(0, cell);
    const auto a = camera.project(joint(motion, 0, 0, 0)), b = camera.project(joint(motion, 0, 1, 0));
    EXPECT_NEAR(std::abs(a.x - b.x), 1.5 * camera.scale(), 0.1 * camera.scale());
}

TEST(Camera, FindsTheFloorUnderAPixel) {
    const auto motion = walkers(1, 10);
    for (const char* view : {"30,15", "-100,60", "top"}) {
        const auto camera = Framing(motion, parse_view(view)).camera(0, cell);
        const cv::Vec3d point(0.3, 0.1, -0.7);
        const auto seen = camera.project(point);
        EXPECT_LT(cv::norm(camera.on_floor({seen.x, seen.y}, 0.1) - point), 1e-9) << view;
    }
}

TEST(Side, FromNames) {
    for (const char* left : {"left hip", "LeftArm", "Hand_L", "l_knee", "L.foot", "LHipJoint", "lefttoe"})
        EXPECT_EQ(side_of(left), Side::left) << left;
    for (const char* right : {"right hip", "UpperLeg_R", "r_knee", "thigh.r", "RThumb"})
        EXPECT_EQ(side_of(right), Side::right) << right;
    for (const char* middle : {"pelvis", "lowerback", "root", "Lumbar", "ribs", "neck", "", "l", "joint_5"})
        EXPECT_EQ(side_of(middle), Side::middle) << middle;
}

}  // namespace
}  // namespace actformer::reports
