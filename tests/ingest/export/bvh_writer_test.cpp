// What is written as BVH, read again.
#include "ingest/export/bvh/bvh_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ingest/export/rotations.hpp"
#include "ingest/formats/bvh/bvh_file.hpp"
#include "tests/support/larger.hpp"
#include "tests/support/skeleton_motion.hpp"

namespace actformer::ingest {
namespace {

using namespace actformer::test;

Recording read_back(const std::string& text) {
    const std::string padded = text + std::string(64, '\0');
    auto result = parse_bvh(std::string_view(padded).substr(0, text.size()));
    if (const auto* why = std::get_if<Rejection>(&result)) {
        ADD_FAILURE() << why->reason;
        return {};
    }
    return std::get<std::vector<Recording>>(std::move(result)).at(0);
}

constexpr double radians = 3.14159265358979323846 / 180;

Matrix turn_about(int axis, double degrees) {
    const double c = std::cos(degrees * radians), s = std::sin(degrees * radians);
    if (axis == 0) return {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    if (axis == 1) return {{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
    return {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

/// (frames, joints of the file) by the file's own channels, in the order of `tree`.
std::vector<Point> places(const Recording& file, const Topology& tree) {
    std::vector<Point> out(file.frames * tree.joints());
    std::vector<Matrix> turned(file.joints.size());
    std::vector<Point> at(file.joints.size());
    for (std::uint32_t t = 0; t < file.frames; ++t)
        for (std::size_t j = 0; j < file.joints.size(); ++j) {
            const auto& joint = file.joints[j];
            Point step = joint.offset;
            Matrix own = matrix({});
            for (std::uint32_t c = 0; c < joint.channels.size(); ++c) {
                const double value = file.channel(joint.first_channel + c)[t];
                const auto kind = static_cast<int>(joint.channels[c]);
                if (kind < 3)
                    step[kind] = value;
                else
                    own = test::product(own, turn_about(kind - 3, value));
            }
            const Matrix above = joint.parent < 0 ? matrix({}) : turned[joint.parent];
            at[j] = test::product(above, step);
            for (std::size_t d = 0; d < 3 && joint.parent >= 0; ++d) at[j][d] += at[joint.parent][d];
            turned[j] = test::product(above, own);
            if (joint.end_site) continue;
            const auto found = std::ranges::find(tree.names, joint.name) - tree.names.begin();
            for (std::size_t d = 0; d < 3; ++d) out[t * tree.joints() + found][d] = at[j][d] / 100;
        }
    return out;
}

/// Joints of both, each relative to its own first root: the reader takes that away.
double furthest_from_first_root(std::vector<Point> a, const std::vector<Point>& b) {
    EXPECT_EQ(a.size(), b.size());
    const Point from = a.at(0);
    double most = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        for (std::size_t d = 0; d < 3; ++d) a[i][d] += b[0][d] - from[d];
        most = larger(most, distance(a[i], b[i]));
    }
    return most;
}

TEST(BvhWriter, RotationsAndSlidesComeBack) {
    std::mt19937 random(1);
    for (int round = 0; round < 20; ++round) {
        const auto tree = made_tree(1 + random() % 20, random);
        const auto motion = made_motion(tree, 5, random);
        const auto file = read_back(bvh_text(motion, 30));
        ASSERT_EQ(file.frames, 5U);
        EXPECT_EQ(file.fps(), 30);
        // The reader's float32 holds angles to 8e-6 degrees; 20 joints of half a metre each make it 1e-6 m.
        EXPECT_LT(furthest_from_first_root(places(file, tree), joints_of(motion)), 5e-6) << round;
    }
}

TEST(BvhWriter, JointsThatSlideHaveSixChannels) {
    const Topology tree{{"a", "b", "c"}, {-1, 0, 1}};
    std::mt19937 random(2);
    auto motion = made_motion(tree, 4, random);
    motion.slides[2] = true;
    for (std::size_t t = 0; t < 4; ++t) motion.position[t * 3 + 2] = made_point(random, 1);
    const auto file = read_back(bvh_text(motion, 120));
    ASSERT_EQ(file.joints.size(), 4U);
    EXPECT_EQ(file.joints[1].channels.size(), 3U);
    EXPECT_EQ(file.joints[2].channels.size(), 6U);
    EXPECT_EQ(file.fps(), 120);
    EXPECT_LT(furthest_from_first_root(places(file, tree), joints_of(motion)), 5e-6);
}

TEST(BvhWriter, TextIsAsOtherProgramsReadIt) {
    SkeletonMotion motion;
    motion.topology = {{"Hips", "Chest", "Leg"}, {-1, 0, 0}};
    motion.frames = 1;
    motion.rest = {Point{}, {0, 0.5, 0}, {0.1, -1, 0}};
    motion.rotation = {{}, {std::sqrt(0.5), std::sqrt(0.5), 0, 0}, {}};
    motion.position = {{1, -0.0, 3}, motion.rest[1], motion.rest[2]};
    motion.slides = {true, false, false};
    EXPECT_EQ(bvh_text(motion, 25),
              "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0.000000 0.000000 0.000000\n"
              "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
              "\tJOINT Chest\n\t{\n\t\tOFFSET 0.000000 50.000000 0.000000\n"
              "\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n"
              "\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 0 0\n\t\t}\n\t}\n"
              "\tJOINT Leg\n\t{\n\t\tOFFSET 10.000000 -100.000000 0.000000\n"
              "\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n"
              "\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 0 0\n\t\t}\n\t}\n}\n"
              "MOTION\nFrames: 1\nFrame Time: 0.04\n"
              "100.000000 0.000000 300.000000 0.000000 0.000000 0.000000 0.000000 90.000000 0.000000 "
              "0.000000 0.000000 0.000000\n");
}

Quaternion times(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Quaternion of_degrees(const Point& zxy) {
    const auto half = [](double degrees) { return degrees * radians / 2; };
    const Quaternion z{std::cos(half(zxy[0])), 0, 0, std::sin(half(zxy[0]))},
        x{std::cos(half(zxy[1])), std::sin(half(zxy[1])), 0, 0},
        y{std::cos(half(zxy[2])), 0, std::sin(half(zxy[2])), 0};
    return times(times(z, x), y);
}

/// The angle between two rotations in radians.
double apart(const Quaternion& a, const Quaternion& b) {
    const auto d = times({a.w, -a.x, -a.y, -a.z}, b);
    return 2 * std::atan2(std::hypot(d.x, d.y, d.z), std::abs(d.w));
}

TEST(ZxyDegrees, MakeTheRotationWhereAnglesLockToo) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> angle(-180, 180);
    for (int i = 0; i < 2000; ++i) {
        const double x = i % 4 == 0   ? 90
                         : i % 4 == 1 ? -90
                         : i % 4 == 2 ? 90 - std::pow(10, -(i % 12))
                                      : angle(random);
        const auto want = of_degrees({angle(random), x, angle(random)});
        // Where angles lock they are found to 1e-7: the threshold in the code.
        EXPECT_LT(apart(of_degrees(zxy_degrees(want, {angle(random), angle(random), angle(random)})), want),
                  5e-7)
            << i;
    }
}

TEST(ZxyDegrees, RunOnAsTheJointDoes) {
    for (const std::size_t axis : {0U, 1U, 2U}) {
        Point before{};
        for (int degrees = 0; degrees <= 1000; degrees += 5) {
            Point want{};
            want[axis] = degrees;
            before = zxy_degrees(of_degrees(want), before);
            for (std::size_t d = 0; d < 3; ++d)
                EXPECT_NEAR(before[d], want[d], 1e-6) << axis << " " << degrees;
        }
    }
}

}  // namespace
}  // namespace actformer::ingest
