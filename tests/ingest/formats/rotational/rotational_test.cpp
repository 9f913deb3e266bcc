#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"
#include "tests/support/made_body.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::ingest;

namespace {

constexpr double pi = std::numbers::pi;

/// Rodrigues' formula, I + sin(a) K + (1 - cos(a)) K^2 with K the axis's cross product.
Rotation rodrigues(std::array<double, 3> v) {
    const double a = std::hypot(v[0], v[1], v[2]);
    const double x = v[0] / a, y = v[1] / a, z = v[2] / a, s = std::sin(a), c = 1 - std::cos(a);
    return {1 - c * (y * y + z * z), c * x * y - s * z,       c * x * z + s * y,
            c * x * y + s * z,       1 - c * (x * x + z * z), c * y * z - s * x,
            c * x * z - s * y,       c * y * z + s * x,       1 - c * (x * x + y * y)};
}

void expect_near(const Rotation& got, const Rotation& wanted, double tolerance) {
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(got[i], wanted[i], tolerance) << i;
}

Quaternion about(std::array<double, 3> v) {
    return of_rotation_vector(v.data());
}

/// A body whose joints all turn, each about its own axis at its own speed, while it walks off; `hz` frames a second.
RotationVectors turning(std::uint64_t frames, double hz, std::size_t joints = smpl_joints) {
    return {frames, joints, [=](std::uint64_t frame, double* vectors, double* translation) {
                const double t = static_cast<double>(frame) / hz;
                for (std::size_t j = 0; j < joints; ++j)
                    for (std::size_t d = 0; d < 3; ++d)
                        vectors[3 * j + d] = d == j % 3 ? (0.3 + 0.1 * static_cast<double>(j)) * t : 0;
                translation[0] = 1.5 * t + 40;
                translation[1] = -2 * t;
                translation[2] = 0.25;
            }};
}

Motion as_motion(const RotationalClip& clip, const RotationalTarget& target) {
    const auto header = target.header("x");
    return {"clip", clip.frames, 1, header.nodes(), header.representation.numbers(), clip.values};
}

}  // namespace

TEST(Quaternion, IsRodriguesRotation) {
    for (const auto v : {std::array{0.3, -1.2, 0.7}, std::array{0.0, 3.1, 0.0}, std::array{2.9, 2.5, -4.0},
                         std::array{1e-5, 2e-5, -1e-5}, std::array{1.1e-4, 0.0, 0.0}})
        expect_near(matrix_of(about(v)), rodrigues(v), 1e-14);
    expect_near(matrix_of(about({0, 0, 0})), {1, 0, 0, 0, 1, 0, 0, 0, 1}, 0);
    const std::array a{0.4, 0.2, -1.0}, b{-0.7, 1.9, 0.1};
    const auto ma = rodrigues(a), mb = rodrigues(b);
    Rotation product{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) product[3 * i + j] += ma[3 * i + k] * mb[3 * k + j];
    expect_near(matrix_of(about(a) * about(b)), product, 1e-14);
}

TEST(Slerp, TurnsAtConstantSpeedTheShorterWay) {
    const auto turned = [](double angle) { return about({0, 0, angle}); };
    for (const double u : {0.0, 0.1, 0.5, 0.75, 1.0}) {
        expect_near(matrix_of(slerp(turned(0.2), turned(1.4), u)), matrix_of(turned(0.2 + 1.2 * u)), 1e-14);
        // A vector that flips from just below pi to just above -pi turns by 0.2, not by 2 pi - 0.2.
        expect_near(matrix_of(slerp(turned(pi - 0.1), turned(-pi + 0.1), u)),
                    matrix_of(turned(pi - 0.1 + 0.2 * u)), 1e-14);
        expect_near(matrix_of(slerp(turned(1), turned(1 + 1e-7), u)), matrix_of(turned(1 + 1e-7 * u)), 1e-15);
        expect_near(matrix_of(slerp(turned(1), turned(1), u)), matrix_of(turned(1)), 0);
    }
}

TEST(Resampled, ShowsTheTimesOfTheNewRate) {
    struct Case {
        std::uint64_t frames;
        double from, to;
        std::uint32_t wanted;
    };
    // 241 frames at 120 last 2 s: 61 at 30. At 100, frame 199 is at 1.99 s, behind 59/30. What 59.99 frames a second mean is not
    // rounded to 60.
    for (const auto& [frames, from, to, wanted] :
         {Case{241, 120, 30, 61}, Case{240, 120, 30, 60}, Case{200, 100, 30, 60}, Case{61, 60, 30, 31},
          Case{61, 59.9999885559082, 30, 31}, Case{100, 250, 30, 12}, Case{10, 25, 30, 11},
          Case{1, 120, 30, 1}}) {
        const auto motion = resampled(turning(frames, from), from, to);
        ASSERT_EQ(motion.frames, wanted) << frames << " at " << from;
        const auto closed = as_recorded(turning(wanted, to));
        for (std::size_t i = 0; i < motion.rotations.size(); ++i)  // 1e-6 of a frame counts as the frame
            expect_near(matrix_of(motion.rotations[i]), matrix_of(closed.rotations[i]), 1e-7);
        for (std::size_t i = 0; i < motion.translation.size(); ++i)
            EXPECT_NEAR(motion.translation[i], closed.translation[i], 1e-7);
    }
    EXPECT_EQ(resampled(turning(0, 30), 30, 30).frames, 0U);
}

TEST(Resampled, JointsThatAFileLacksDoNotTurn) {
    const auto motion = resampled(turning(5, 120, 22), 120, 30);
    EXPECT_EQ(motion.pose(1)[22], Quaternion{});
    EXPECT_EQ(motion.pose(1)[23], Quaternion{});
    EXPECT_NE(motion.pose(1)[21], Quaternion{});
    // Of SMPL+H's 52 the first 24 are read, as they stand.
    EXPECT_NE(as_recorded(turning(5, 120, 52)).pose(1)[23], Quaternion{});
}

TEST(Resampled, NamesTheFrameOfANumberThatIsNone) {
    auto file = turning(9, 120);
    file.read = [read = file.read](std::uint64_t frame, double* vectors, double* translation) {
        read(frame, vectors, translation);
        if (frame == 4) vectors[7] = std::nan("");
    };
    const auto said = [](auto make) {
        try {
            make();
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string("taken");
    };
    EXPECT_EQ(said([&] { resampled(file, 120, 30); }), "frame 4: a number that is not finite");
    EXPECT_EQ(said([&] { as_recorded(file); }), "frame 4: a number that is not finite");
    file.frames = std::uint64_t{1} << 40;
    EXPECT_EQ(said([&] { as_recorded(file); }), "1099511627776 frames, more than a clip may have");
}

TEST(Turn, TakesTheBodyAlong) {
    auto motion = as_recorded(turning(3, 30));
    const auto before = motion;
    turn(motion, z_up_to_y_up);
    for (std::size_t t = 0; t < 3; ++t) {
        const double *was = &before.translation[3 * t], *is = &motion.translation[3 * t];
        EXPECT_NEAR(is[0], was[0], 1e-12);
        EXPECT_NEAR(is[1], was[2], 1e-12);
        EXPECT_NEAR(is[2], -was[1], 1e-12);
        const auto a = matrix_of(before.pose(t)[0]), b = matrix_of(motion.pose(t)[0]);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(b[c], a[c], 1e-12);
            EXPECT_NEAR(b[3 + c], a[6 + c], 1e-12);
            EXPECT_NEAR(b[6 + c], -a[3 + c], 1e-12);
        }
        EXPECT_EQ(motion.pose(t)[5], before.pose(t)[5]);
    }
    turn(motion, y_down_to_y_up);
    EXPECT_NEAR(motion.translation[1], -before.translation[2], 1e-12);
}

TEST(RotationalTrack, RepresentationsShowTheSameJoints) {
    const auto motion = as_recorded(turning(40, 30));
    std::vector<std::vector<float>> joints;
    for (const char* name : {"rot6d", "limb", "xyz"}) {
        RotationalOptions options;
        options.representation = name;
        const auto target = options.target();
        const auto clip = RotationalTrack(motion, target).cut(10, 40);
        ASSERT_EQ(clip->frames, 30U);
        const auto header = target.header("x");
        EXPECT_EQ(header.origin.text(), "recorded, generic skeleton");
        std::vector<std::unique_ptr<RawClip>> raw;
        raw.push_back(RotationalTrack(motion, target).cut(10, 40));
        std::vector<std::uint32_t> frames;
        const auto cleaned = gathered(raw, target, frames);
        EXPECT_EQ(frames, std::vector<std::uint32_t>{30});
        ASSERT_TRUE(std::equal(cleaned.motion.begin(), cleaned.motion.end(), clip->values.begin(),
                               clip->values.end()));
        joints.push_back(joint_positions(as_motion(*clip, target), {header.representation, header.topology,
                                                                    cleaned.bone_length, header.rest}));
    }
    ASSERT_EQ(joints[0].size(), joints[2].size());
    for (std::size_t i = 0; i < joints[0].size(); ++i) {
        EXPECT_NEAR(joints[0][i], joints[2][i], 1e-6);
        // Limbs are divided by their length and 1e-4, which draws joints together by as much a limb: eight of them at most.
        EXPECT_NEAR(joints[1][i], joints[2][i], 1e-3);
    }
}

TEST(RotationalTrack, NumbersAreRowsOfTheMatrixAndThePaddedTranslation) {
    const auto motion = as_recorded(turning(7, 30));
    const RotationalTrack track(motion, {});
    EXPECT_EQ(track.frames(), 7U);
    for (const auto& [first, last] :
         {std::pair{0U, 7U}, std::pair{2U, 5U}, std::pair{1U, 6U}, std::pair{6U, 7U}}) {
        const auto clip = track.cut(first, last);  // clips that overlap do not spoil each other
        const double mean_x = 1.5 * (first + last - 1) / 2 / 30, mean_y = -2.0 * (first + last - 1) / 2 / 30;
        for (std::size_t t = 0; t < clip->frames; ++t) {
            const float* row = &clip->values[t * 25 * 6];
            for (std::size_t j = 0; j < smpl_joints; ++j) {
                const auto m = matrix_of(motion.pose(first + t)[j]);
                for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(row[6 * j + i], static_cast<float>(m[i]));
            }
            const double now = static_cast<double>(first + t) / 30;
            EXPECT_NEAR(row[144], 1.5 * now - mean_x, 1e-6);
            EXPECT_NEAR(row[145], -2 * now - mean_y, 1e-6);
            EXPECT_NEAR(row[146], 0, 1e-6);
            for (std::size_t i = 147; i < 150; ++i) EXPECT_EQ(row[i], 0);
        }
    }
}

// A body twice as tall as the generic one has all heights twice as large, and says whose they are.
TEST(RotationalOptions, ABodyGivesTheRestSkeleton) {
    const test::TempDir folder;
    auto body = test::made_body();
    auto& places = body["v_template"].values;
    for (std::size_t i = 1; i < places.size(); i += 3) places[i] *= 2;
    test::write_body(folder / "tall.npz", body);
    RotationalOptions options;
    options.body = (folder / "tall.npz").string();
    const auto target = options.target();
    const auto header = target.header("x");
    EXPECT_EQ(header.origin.skeleton, "tall.npz");
    const auto generic = generic_skeleton().rest();
    ASSERT_EQ(header.rest.size(), generic.size());
    for (std::size_t i = 0; i < generic.size(); ++i)
        EXPECT_NEAR(header.rest[i], generic[i] * (i % 3 == 1 ? 2.0F : 1.0F), 1e-6);
    EXPECT_NE(target.text(), RotationalOptions().target().text());
    options.body = (folder / "nowhere.npz").string();
    EXPECT_THROW(options.target(), Error);
}
