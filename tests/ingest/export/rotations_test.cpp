// From joints to rotations and back.
#include "ingest/export/rotations.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ingest/export/rest_pose.hpp"
#include "tests/support/skeleton_motion.hpp"

namespace actformer::ingest {
namespace {

using namespace actformer::test;

double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double length(const Point& a) {
    return std::sqrt(dot(a, a));
}

/// Joints that wander freely: neither lengths nor angles stay.
std::vector<Point> loose_joints(std::size_t frames, std::size_t joints, std::mt19937& random) {
    std::vector<Point> out;
    for (std::size_t i = 0; i < frames * joints; ++i) out.push_back(made_point(random, 1));
    return out;
}

std::vector<Point> pose_of(std::size_t joints, std::mt19937& random) {
    std::vector<Point> out;
    for (std::size_t j = 0; j < joints; ++j) out.push_back(made_point(random, 1));
    return out;
}

std::size_t children(const Topology& tree, std::size_t joint) {
    return static_cast<std::size_t>(std::ranges::count(tree.parents, static_cast<int>(joint)));
}

// In double, trees of 20 joints: rounding alone, some 1e-15 of a few metres.
constexpr double rounding = 1e-12;

TEST(MinimalTwist, RigidSkeletonsComeBackByRotationsAlone) {
    std::mt19937 random(1);
    for (int round = 0; round < 20; ++round) {
        const auto tree = made_tree(2 + random() % 20, random);
        const auto joints = joints_of(made_motion(tree, 9, random));
        const auto found = minimal_twist(tree, joints, pose_of(tree.joints(), random));
        EXPECT_LT(furthest(joints_of(found), joints), rounding) << round;
        EXPECT_EQ(std::ranges::count(found.slides, true), 1) << round;
        EXPECT_TRUE(found.slides[0]);
    }
}

TEST(MinimalTwist, LooseSkeletonsComeBackByPositionsThatMove) {
    std::mt19937 random(2);
    for (int round = 0; round < 20; ++round) {
        const auto tree = made_tree(2 + random() % 20, random);
        const auto joints = loose_joints(7, tree.joints(), random);
        const auto found = minimal_twist(tree, joints, pose_of(tree.joints(), random));
        EXPECT_LT(furthest(joints_of(found), joints), rounding) << round;
    }
}

// Hips that see-saw against the spine, as a depth camera sees them: the legs' bones must not slide for it.
TEST(MinimalTwist, OnlyChildrenOfLooseJointsSlide) {
    const Topology tree{{"pelvis", "spine", "left", "right", "left knee", "right knee", "head"},
                        {-1, 0, 0, 0, 2, 3, 1}};
    std::mt19937 random(3);
    auto motion = made_motion(tree, 8, random);
    for (std::size_t t = 0; t < 8; ++t) motion.position[t * 7 + 2][1] += 0.01 * static_cast<double>(t);
    const auto joints = joints_of(motion);
    const auto found = minimal_twist(tree, joints, pose_of(7, random));
    EXPECT_LT(furthest(joints_of(found), joints), rounding);
    EXPECT_EQ(found.slides, (std::vector<bool>{true, true, true, true, false, false, false}));
}

// A rotation has no twist about a direction if its axis is square to it.
TEST(MinimalTwist, JointsWithOneChildSwingOnly) {
    std::mt19937 random(4);
    const auto tree = made_tree(15, random);
    const auto found = minimal_twist(tree, joints_of(made_motion(tree, 20, random)), pose_of(15, random));
    std::size_t seen = 0;
    for (std::size_t c = 1; c < 15; ++c) {
        const auto j = static_cast<std::size_t>(tree.parents[c]);
        if (children(tree, j) != 1) continue;
        for (std::size_t t = 0; t < 20; ++t, ++seen) {
            const auto& q = found.turn(t, j);
            EXPECT_NEAR(dot({q.x, q.y, q.z}, found.rest[c]) / length(found.rest[c]), 0, rounding);
        }
    }
    EXPECT_GT(seen, 0U);
}

// The best of many: no rotation a little off does better.
TEST(MinimalTwist, JointsWithSeveralChildrenTakeTheBestRotation) {
    const Topology tree{{"a", "b", "c", "d"}, {-1, 0, 0, 0}};
    std::mt19937 random(5);
    const auto joints = loose_joints(30, 4, random);
    const auto found = minimal_twist(tree, joints, pose_of(4, random));
    const auto error = [&](const Quaternion& q, std::size_t t) {
        double sum = 0;
        for (std::size_t c = 1; c < 4; ++c) {
            Point now, rest = found.rest[c];
            for (std::size_t d = 0; d < 3; ++d) now[d] = joints[t * 4 + c][d] - joints[t * 4][d];
            const auto turned = test::product(matrix(q), rest);
            for (std::size_t d = 0; d < 3; ++d)
                sum += std::pow(now[d] / length(now) - turned[d] / length(rest), 2);
        }
        return sum;
    };
    for (std::size_t t = 0; t < 30; ++t) {
        const auto& best = found.turn(t, 0);
        for (int other = 0; other < 200; ++other) {
            const auto r = made_rotation(random);
            const double near = other % 2 == 0 ? 1 : 0.01;  // anywhere, or beside it
            Quaternion q{best.w + near * r.w, best.x + near * r.x, best.y + near * r.y, best.z + near * r.z};
            const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
            q = {q.w / norm, q.x / norm, q.y / norm, q.z / norm};
            EXPECT_LE(error(best, t), error(q, t) + rounding);
        }
    }
}

TEST(MinimalTwist, ChildrenOnOneLineLeaveNoTwist) {
    const Topology tree{{"a", "b", "c"}, {-1, 0, 0}};
    std::mt19937 random(6);
    std::vector<Point> joints;
    for (int t = 0; t < 20; ++t) {
        const auto v = made_point(random, 1);
        joints.push_back({0, 0, 0});
        joints.push_back({v[0] / length(v), v[1] / length(v), v[2] / length(v)});
        joints.push_back({-2 * v[0] / length(v), -2 * v[1] / length(v), -2 * v[2] / length(v)});
    }
    const std::vector<Point> pose{{}, {1, 0, 0}, {-1, 0, 0}};
    const auto found = minimal_twist(tree, joints, pose);
    EXPECT_LT(furthest(joints_of(found), joints), rounding);
    for (std::size_t t = 0; t < 20; ++t) EXPECT_NEAR(found.turn(t, 0).x, 0, rounding);
}

// A limb that goes round passes the far side of its rest pose, where the smallest rotation turns about: signs still follow.
TEST(MinimalTwist, NeighboursInTimeLieInOneHalfSpace) {
    const Topology tree{{"a", "b", "c"}, {-1, 0, 1}};
    std::vector<Point> joints;
    constexpr double pi = 3.14159265358979323846;
    for (int t = 0; t <= 720; ++t) {
        const double angle = t * pi / 180;
        joints.push_back({0, 0, 0});
        joints.push_back({0, std::cos(angle), std::sin(angle)});
        joints.push_back({0, 2 * std::cos(angle), std::sin(angle) + 0.5});
    }
    const auto found = minimal_twist(tree, joints, std::vector<Point>{{}, {0, 1, 0}, {0, 1, 0}});
    EXPECT_LT(furthest(joints_of(found), joints), 1e-9);
    for (std::size_t t = 1; t < found.frames; ++t)
        for (std::size_t j = 0; j < 3; ++j) {
            const auto &a = found.turn(t - 1, j), &b = found.turn(t, j);
            EXPECT_GE(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z, 0) << t;
        }
    // The root turns by a degree a frame throughout.
    for (std::size_t t = 1; t < found.frames; ++t) {
        const auto &a = found.turn(t - 1, 0), &b = found.turn(t, 0);
        EXPECT_NEAR(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z, std::cos(pi / 360), 1e-9) << t;
    }
}

// The rotation itself, which positions that move would hide: it turns the rest bone to the bone of the frame.
TEST(MinimalTwist, OppositeBonesTurnAllTheWay) {
    const Topology tree{{"a", "b"}, {-1, 0}};
    for (const double off : {0.0, 1e-17, 1e-15, 1e-13, 1e-11, 1e-8, 1e-4}) {
        const std::vector<Point> joints{{0, 0, 0}, {off, -1, 0}};
        const auto found = minimal_twist(tree, joints, std::vector<Point>{{}, {0, 1, 0}});
        const auto& q = found.turn(0, 0);
        // R(q) (0, 1, 0)
        EXPECT_NEAR(2 * (q.x * q.y - q.w * q.z), off, 2e-12) << off;
        EXPECT_NEAR(1 - 2 * (q.x * q.x + q.z * q.z), -1, 2e-8) << off;
        EXPECT_NEAR(2 * (q.y * q.z + q.w * q.x), 0, 2e-12) << off;
    }
}

TEST(MinimalTwist, BonesWithoutLengthAreTaken) {
    const Topology tree{{"a", "b", "c", "d"}, {-1, 0, 1, 1}};
    std::vector<Point> joints(3 * 4, Point{1, 2, 3});  // all in one place ...
    joints[6] = {1, 3, 3};                             // ... but for one bone in one frame
    const auto found = minimal_twist(tree, joints, std::vector<Point>(4, Point{}));
    EXPECT_LT(furthest(joints_of(found), joints), rounding);
    for (const auto& q : found.rotation)
        EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, rounding);
}

TEST(TPose, IsKnownForNtuSmplAndGta) {
    EXPECT_TRUE(t_pose({{"a", "b"}, {-1, 0}}).empty());
    const auto pose = t_pose(ntu25());
    ASSERT_EQ(pose.size(), 25U);
    for (std::size_t j = 0; j < 25; ++j) {
        EXPECT_EQ(length(pose[j]) > 0, j > 0) << j;
        const auto& name = ntu25().names[j];
        const int side = name.starts_with("left") ? 1 : name.starts_with("right") ? -1 : 0;
        EXPECT_GE(side * pose[j][0], 0) << name;
        EXPECT_EQ(pose[j][2] > 0, name.ends_with("foot") || name.ends_with("thumb")) << name;
    }
}

}  // namespace
}  // namespace actformer::ingest
