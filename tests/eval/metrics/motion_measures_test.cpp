// Accelerations, speeds, sliding and distances of motions made to have known ones.
#include "eval/metrics/motion_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace actformer::eval;

namespace {

/// A root and a foot below it.
MeasuredBody body() {
    MeasuredBody out;
    out.parents = {-1, 0};
    out.feet = {1};
    out.fps = 10;
    return out;
}

/// Positions (frames, persons, 2, 3) by what `root` and `foot` say of a frame and a person.
template <typename Root, typename Foot>
std::vector<float> motion(std::size_t frames, std::size_t persons, const Root& root, const Foot& foot) {
    std::vector<float> out;
    for (std::size_t t = 0; t < frames; ++t)
        for (std::size_t p = 0; p < persons; ++p) {
            const std::array<double, 3> r = root(static_cast<double>(t), p),
                                        f = foot(static_cast<double>(t), p);
            for (const double v : r) out.push_back(static_cast<float>(v));
            for (const double v : f) out.push_back(static_cast<float>(v));
        }
    return out;
}

std::vector<std::size_t> first(std::size_t n) {
    std::vector<std::size_t> out(n);
    std::iota(out.begin(), out.end(), std::size_t{0});
    return out;
}

using Place = std::array<double, 3>;

}  // namespace

TEST(MotionMeasures, AccelerationIsTheSecondDifference) {
    // The root at x = t^2 / 2 hundredths of a metre, the foot two more behind it in z: 1 and 4 hundredths a frame squared.
    const auto values = motion(
        9, 1,
        [](double t, auto) {
            return Place{0.005 * t * t, 0, 0};
        },
        [](double t, auto) {
            return Place{0.005 * t * t, -1, 0.02 * t * t};
        });
    MotionMeasures got;
    measure(values, 9, 1, body(), got);
    EXPECT_NEAR(got.root_acceleration[0], 0.01 * 100, 1e-4);
    EXPECT_NEAR(got.limb_acceleration[0], 0.04 * 100, 1e-4);
    EXPECT_EQ(got.columns, 0U);
}

TEST(MotionMeasures, RootSpeedIsTheMeanOverStepsAndPersons) {
    // Metres a frame, 10 frames a second: one root goes on at 0.05 in x and z, one goes up and down, one stands. Feet do not count.
    const auto root = [](double t, std::size_t p) {
        return p == 0   ? Place{0.03 * t, 1, 0.04 * t}
               : p == 1 ? Place{0, std::fmod(t, 2) * 0.25, 0}
                        : Place{0, 1, 0};
    };
    const auto foot = [](double t, std::size_t) { return Place{7 * t, 0, 0}; };
    MotionMeasures got;
    measure(motion(9, 1, root, foot), 9, 1, body(), got);
    measure(motion(9, 3, root, foot), 9, 3, body(), got);
    measure(motion(2, 1, root, foot), 2, 1, body(), got);
    measure(motion(1, 1, root, foot), 1, 1, body(), got);
    ASSERT_EQ(got.root_speed.size(), 4U);
    EXPECT_NEAR(got.root_speed[0], 0.5, 1e-5);
    EXPECT_NEAR(got.root_speed[1], (0.5 + 2.5 + 0) / 3, 1e-5);
    EXPECT_NEAR(got.root_speed[2], 0.5, 1e-5);
    EXPECT_EQ(got.root_speed[3], 0) << "one frame";
}

TEST(MotionMeasures, RootSpeedIsTimesThatOfRealMotions) {
    const auto at = [](double speed) {
        return [speed](double t, std::size_t) { return Place{0.1 * speed * t, 1, 0}; };
    };
    const auto of = [&](const std::vector<double>& speeds) {
        MotionMeasures out;
        for (const double speed : speeds) measure(motion(30, 1, at(speed), at(speed)), 30, 1, body(), out);
        return out;
    };
    const auto real = of({1, 2, 3}), made = of({1.5, 2.5, 8});
    EXPECT_NEAR(*compare(real, first(3), made, first(3)).root_speed, 2, 1e-5);
    EXPECT_NEAR(*compare(real, first(2), made, first(1)).root_speed, 1, 1e-5);
    EXPECT_FALSE(compare(of({0}), first(1), made, first(3)).root_speed) << "real roots that stand";
    auto before = made;  // as a file has them that was written before there was a root speed
    before.root_speed.clear();
    const auto score = compare(real, first(3), before, first(3));
    EXPECT_FALSE(score.root_speed);
    EXPECT_TRUE(score.foot_sliding);
}

TEST(MotionMeasures, FeetSlideWhileTheyAreNearTheFloor) {
    // On the floor for five frames, moving 3 cm a frame; then far above it and fast.
    const auto foot = [](double t, auto) {
        return t < 5 ? Place{0.03 * t, 0.01 * (t < 3 ? 0 : 1), 0} : Place{5 * t, 0.8, 0};
    };
    const auto values = motion(
        9, 1,
        [](double, auto) {
            return Place{0, 1, 0};
        },
        foot);
    MotionMeasures got;
    measure(values, 9, 1, body(), got);
    EXPECT_NEAR(got.foot_sliding[0], 0.3, 1e-5) << "m/s at 10 frames a second";
    auto hanging = body();
    hanging.up_sign = -1;
    measure(values, 9, 1, hanging, got);
    EXPECT_NEAR(got.foot_sliding[1], 50, 1e-3) << "upside down the fast part is the lowest";
    auto footless = body();
    footless.feet.clear();
    MotionMeasures none;
    measure(values, 9, 1, footless, none);
    EXPECT_TRUE(none.foot_sliding.empty());
    EXPECT_EQ(feet_among(std::vector<std::string>{"hip", "LeftFoot", "ankle", "ToeBase"}),
              (std::vector<std::size_t>{1, 3}));
    EXPECT_EQ(feet_among(std::vector<std::string>{"hip", "left ankle"}), (std::vector<std::size_t>{1}));
}

TEST(MotionMeasures, DistancesAreOfEveryPairOfRoots) {
    const auto at = [](double, std::size_t p) { return Place{static_cast<double>(p * p), 0, 0}; };
    MotionMeasures got;
    measure(motion(20, 3, at, at), 20, 3, body(), got);
    ASSERT_EQ(got.columns, 3 * distance_frames);
    ASSERT_EQ(got.distances.size(), got.columns);
    for (std::size_t i = 0; i < distance_frames; ++i) {
        EXPECT_EQ(got.distances[3 * i], 1);      // 0 and 1
        EXPECT_EQ(got.distances[3 * i + 1], 4);  // 0 and 2
        EXPECT_EQ(got.distances[3 * i + 2], 3);
    }
}

TEST(MotionMeasures, WassersteinOfSetsOfAnySizes) {
    EXPECT_DOUBLE_EQ(wasserstein({0, 1, 3}, {5, 6, 8}), 5);
    EXPECT_DOUBLE_EQ(wasserstein({0, 1}, {0, 0, 1, 1}), 0);
    EXPECT_DOUBLE_EQ(wasserstein({0}, {0, 1, 2, 5}), 2);
    // Of as many numbers on both sides it is the mean distance of the sorted.
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::vector<float> a, b;
    for (int i = 0; i < 200; ++i) {
        a.push_back(normal(random));
        b.push_back(2 * normal(random) + 0.5F);
    }
    const double got = wasserstein(a, b);
    std::ranges::sort(a);
    std::ranges::sort(b);
    double mean = 0;
    for (std::size_t i = 0; i < a.size(); ++i) mean += std::abs(a[i] - b[i]) / 200;
    EXPECT_NEAR(got, mean, 1e-6);
}

TEST(MotionMeasures, AreComparedOverTheMotionsNamed) {
    MotionMeasures real{{1, 3}, {2, 2}, {1, 2}, {0.1F, 0.3F}, {1, 1, 2, 2}, 2},
        made{{4, 8, 90}, {1, 1, 90}, {3, 6, 90}, {0.2F, 0.4F, 90}, {3, 3, 3, 3, 90, 90}, 2};
    const std::vector<std::size_t> some{0, 1};
    const auto score = compare(real, first(2), made, some);
    EXPECT_DOUBLE_EQ(*score.limb_acceleration, 3);
    EXPECT_DOUBLE_EQ(*score.root_acceleration, 0.5);
    EXPECT_DOUBLE_EQ(*score.root_speed, 3);
    EXPECT_NEAR(*score.foot_sliding, 0.3, 1e-6);
    EXPECT_DOUBLE_EQ(*score.root_distance, 1.5);
    const auto same = compare(real, first(2), subset(made, {1, 0}), some);
    EXPECT_DOUBLE_EQ(*same.limb_acceleration, 3);
    EXPECT_DOUBLE_EQ(*same.root_speed, 3);
    EXPECT_FALSE(compare(real, {}, made, some).limb_acceleration);
    made.foot_sliding.clear();
    made.columns = 0;
    EXPECT_FALSE(compare(real, first(2), made, some).foot_sliding);
    EXPECT_FALSE(compare(real, first(2), made, some).root_distance);
}
