// Performances as rotations of SMPL's joints: they show what the figures show, stand upright, and keep their feet on the floor.
#include "ingest/synth/smpl/smpl_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ingest/synth/programmes/everyday.hpp"
#include "ingest/synth/programmes/exercises.hpp"
#include "ingest/synth/programmes/ntu.hpp"
#include "ingest/synth/rotation_vector.hpp"
#include "tests/support/larger.hpp"

namespace actformer::ingest::synth {
namespace {

double apart(const Rotation& a, const Rotation& b) {
    return test::larger(test::larger(length(a.x - b.x), length(a.y - b.y)), length(a.z - b.z));
}

double angle(const Vec& a, const Vec& b) {
    return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / pi;
}

/// All programmes of one person, with names for messages.
std::vector<std::pair<std::string, const Programme*>> solos() {
    std::vector<std::pair<std::string, const Programme*>> out;
    for (int action = 1; action <= 120; ++action)
        if (programme_of(action).persons == 1)
            out.emplace_back(std::to_string(action), &programme_of(action));
    static const auto day = [] {
        std::vector<NamedProgramme> all;
        for (const auto& table : {locomotion(), postures(), handling()})
            all.insert(all.end(), table.begin(), table.end());
        return all;
    }();
    for (const auto& one : day) out.emplace_back(one.name, &one.programme);
    for (const auto& one : exercises()) out.emplace_back(one.name, &one.programme);
    return out;
}

TEST(RotationVectors, ComeBackAndAreShort) {
    Random random{1};
    for (int i = 0; i < 2000; ++i) {
        const Vec axis = normalised({random.normal(), random.normal(), random.normal()});
        // Many near 0 and near half a turn, where the formulas cancel.
        const double degrees = i % 3 == 0   ? random.uniform(0, 180)
                               : i % 3 == 1 ? 180 - std::pow(10, random.uniform(-9, 1))
                                            : std::pow(10, random.uniform(-9, 1));
        const Rotation r{turned({1, 0, 0}, axis, degrees), turned({0, 1, 0}, axis, degrees),
                         turned({0, 0, 1}, axis, degrees)};
        const Vec v = rotation_vector(r);
        EXPECT_LT(apart(rotation_of(v), r), 1e-7) << degrees;
        EXPECT_NEAR(length(v), radians(degrees), 1e-7);
        EXPECT_LT(apart(r * inverse(r), {}), 1e-12);
    }
    EXPECT_LT(apart(slerp(about_y(10), about_y(50), 0.25), about_y(20)), 1e-12);
    EXPECT_LT(length(shortest_turn({0, 1, 0}, {0, 0, 1}) * Vec{0, 1, 0} - Vec{0, 0, 1}), 1e-12);
}

TEST(SmplPoses, BonesPointAsTheFiguresDo) {
    for (const int action : {1, 7, 24, 43, 80, 101}) {
        const Casting casting{{5, static_cast<std::uint64_t>(action)}, {{smpl_body(), 3}}};
        const auto scene = play(programme_of(action), casting);
        for (std::size_t f = 0; f < scene.frames.size(); f += 7) {
            const auto& figure = scene.frames[f][0];
            const auto pose = smpl_pose(figure);
            const auto at = smpl_places(pose);
            const std::array<std::array<int, 4>, 12> bones{{{1, 4, left_hip, left_knee},
                                                            {4, 7, left_knee, left_ankle},
                                                            {7, 10, left_ankle, left_foot},
                                                            {2, 5, right_hip, right_knee},
                                                            {5, 8, right_knee, right_ankle},
                                                            {8, 11, right_ankle, right_foot},
                                                            {16, 18, left_shoulder, left_elbow},
                                                            {18, 20, left_elbow, left_wrist},
                                                            {20, 22, left_wrist, left_hand},
                                                            {17, 19, right_shoulder, right_elbow},
                                                            {19, 21, right_elbow, right_wrist},
                                                            {21, 23, right_wrist, right_hand}}};
            for (const auto& [a, b, from, to] : bones)
                EXPECT_LT(angle(at[static_cast<std::size_t>(b)] - at[static_cast<std::size_t>(a)],
                                figure.at[static_cast<std::size_t>(to)] -
                                    figure.at[static_cast<std::size_t>(from)]),
                          1e-4)
                    << "action " << action << " frame " << f << " bone " << a << "-" << b;
            for (const auto& [joint, of_figure] :
                 {std::pair{7, left_ankle}, {8, right_ankle}, {10, left_foot}, {11, right_foot}})
                EXPECT_LT(length(at[static_cast<std::size_t>(joint)] - figure.at[of_figure]), 1e-6) << action;
            for (const auto& turn : pose.turned) EXPECT_LT(apart(turn * inverse(turn), {}), 1e-9);
            // Seen in a mirror twice it is the same; once, left and right are exchanged.
            const auto twice = smpl_places(mirrored(mirrored(pose))), once = smpl_places(mirrored(pose));
            EXPECT_LT(length(twice[22] - at[22]), 1e-9);
            EXPECT_LT(length(once[23] - Vec{-at[22].x, at[22].y, at[22].z}), 1e-9);
        }
    }
}

TEST(SmplPoses, PeopleStandOnTheFloorAndMoveWithoutJumps) {
    for (const auto& [name, programme] : solos()) {
        const auto motion = smpl_solo(*programme, {7, 1}, 2, of_video);
        double lowest = 9;
        std::vector<double> feet;
        for (std::size_t f = 0; f < motion.size(); ++f) {
            const auto at = smpl_places(motion[f]);
            for (std::size_t j = 0; j < smpl_joints; ++j) {
                lowest = std::min(lowest, at[j].y);
                if (f > 0) {
                    EXPECT_LT(length(at[j] - smpl_places(motion[f - 1])[j]), 0.42) << name << " joint " << j;
                }
            }
            feet.push_back(std::min(at[10].y, at[11].y));
        }
        EXPECT_GT(lowest, -0.12) << name;
        std::nth_element(feet.begin(), feet.begin() + std::ssize(feet) / 2, feet.end());
        // The balls of the feet are 4.5 cm above the soles; half the time at least one foot stands.
        EXPECT_NEAR(feet[feet.size() / 2], 0.045, 0.05) << name;
    }
}

std::vector<SmplPose> still(const Programme& programme) {
    const Casting casting{{5, 2}, {{smpl_body(), 3}}};
    std::vector<SmplPose> out;
    for (const auto& figures : play(programme, casting).frames) out.push_back(smpl_pose(figures[0]));
    return out;
}

TEST(Life, TurnsEveryJointAndLeavesFeetHandsAndChestWhereTheyAre) {
    for (const auto& [name, programme] : solos()) {
        const auto before = still(*programme);
        auto after = before;
        enliven(after, of_video, Random{1, 2});
        ASSERT_EQ(after.size(), before.size());
        std::array<double, smpl_joints> most{};
        for (std::size_t f = 0; f < before.size(); ++f) {
            const auto a = smpl_placed(before[f]), b = smpl_placed(after[f]);
            // Legs as good as straight may fall short by some millimetres. The spine's turns move the chest by some centimetres at
            // most, and with it the hands of arms that are stretched out.
            for (const std::size_t j : {7, 8, 10, 11})
                EXPECT_LT(length(a.at[j] - b.at[j]), 0.006) << name << " joint " << j << " frame " << f;
            for (const std::size_t j : {9, 15, 20, 21, 22, 23})
                EXPECT_LT(length(a.at[j] - b.at[j]), 0.05) << name << " joint " << j << " frame " << f;
            for (const std::size_t j : {7, 8, 9, 20, 21})
                EXPECT_LT(apart(a.world[j], b.world[j]), 1e-9) << name << " joint " << j << " frame " << f;
            for (std::size_t j = 0; j < smpl_joints; ++j) {
                EXPECT_LT(apart(after[f].turned[j] * inverse(after[f].turned[j]), {}), 1e-9);
                most[j] = std::max(most[j], apart(before[f].turned[j], after[f].turned[j]));
                if (f > 0) {
                    EXPECT_LT(length(b.at[j] - smpl_placed(after[f - 1]).at[j]), 0.42) << name << " " << j;
                }
            }
        }
        for (std::size_t j = 0; j < smpl_joints; ++j)
            EXPECT_GT(most[j], radians(1)) << name << " joint " << j;
    }
}

TEST(Life, OfNoTurnsIsThePerformanceItself) {
    const auto before = still(everyday_programme("walk"));
    auto after = before;
    enliven(after, {}, Random{1});
    for (std::size_t f = 0; f < before.size(); ++f)
        for (std::size_t j = 0; j < smpl_joints; ++j)
            EXPECT_LT(apart(before[f].turned[j], after[f].turned[j]), 1e-6) << f << " joint " << j;
}

TEST(SmplPoses, ToesStayOnTheFloorWhenTheHeelRises) {
    const auto motion = still(everyday_programme("walk"));
    double most = 0;
    for (const auto& pose : motion) {
        const auto placed = smpl_placed(pose);
        for (const std::size_t toes : {10, 11}) {
            const double heel = -std::asin(placed.world[toes - 3].z.y) * 180 / pi;
            if (heel < 5 || placed.at[toes].y > 0.075 + smpl_offsets()[toes].y + 0.015) continue;
            most = std::max(most, heel);
            EXPECT_NEAR(placed.world[toes].z.y, 0, 0.02) << "a heel at " << heel << " degrees";
        }
    }
    EXPECT_GT(most, 10) << "a heel rises";
}

TEST(SmplPoses, WhoStandsIsUpright) {
    for (const auto name : {"stand", "walk", "look", "communicate"}) {
        const auto motion = smpl_solo(everyday_programme(name), {3, 1}, 4, of_video);
        for (std::size_t f = 0; f < motion.size(); f += 5) {
            const auto at = smpl_places(motion[f]);
            EXPECT_LT(angle(at[12] - at[0], {0, 1, 0}), 14) << name << " frame " << f;
            EXPECT_GT(at[15].y, 1.3) << name;
        }
    }
}

TEST(SmplMotions, GoOnWhereTheyEnd) {
    auto motion = smpl_solo(everyday_programme("walk"), {1, 1}, 4, of_video);
    place(motion, 70, {1, 0, -2});
    const auto before = motion.size();
    const auto next = smpl_solo(everyday_programme("turn"), {1, 2}, 4, of_video);
    go_on(motion, next, 10);
    ASSERT_EQ(motion.size(), before + 10 + next.size());
    for (std::size_t f = before - 2; f < before + 14; ++f)
        for (std::size_t j = 0; j < smpl_joints; ++j)
            EXPECT_LT(length(smpl_places(motion[f])[j] - smpl_places(motion[f - 1])[j]), 0.2)
                << f << " " << j;
    const auto &last = motion[before - 1], &first = motion[before + 10];
    EXPECT_NEAR(heading_of(last), heading_of(first), 1e-6);
    EXPECT_NEAR(last.pelvis.x, first.pelvis.x, 1e-9);
    EXPECT_NEAR(last.pelvis.z, first.pelvis.z, 1e-9);
}

TEST(SmplMotions, AreResampledInTime) {
    SmplMotion motion(4);
    for (std::size_t f = 0; f < 4; ++f) {
        motion[f].pelvis = {static_cast<double>(f), 0, 0};
        motion[f].turned[3] = about_x(10.0 * static_cast<double>(f));
    }
    const auto fast = resampled(motion, 120), odd = resampled(motion, 59.9999885559082);
    ASSERT_EQ(fast.size(), 13U);
    EXPECT_NEAR(fast[5].pelvis.x, 1.25, 1e-12);
    EXPECT_LT(apart(fast[5].turned[3], about_x(12.5)), 1e-9);
    EXPECT_EQ(odd.size(), 6U) << "the seventh would come after the last frame";
    EXPECT_NEAR(odd[1].pelvis.x, 30 / 59.9999885559082, 1e-12);
    EXPECT_NEAR(in_axes(motion, z_up)[0].pelvis.y, 0, 1e-12);
    EXPECT_EQ((z_up * Vec{0, 1, 0}).z, 1);
    EXPECT_EQ((below_camera * Vec{0, 1, 2}).z, -2);
}

}  // namespace
}  // namespace actformer::ingest::synth
