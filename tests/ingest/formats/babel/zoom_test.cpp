#include "ingest/formats/babel/zoom.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace actformer::ingest;

TEST(Zoom, CountsFramesAsPythonRounds) {
    EXPECT_EQ(zoomed_frames(121, 120, 30), 30U);
    EXPECT_EQ(zoomed_frames(122, 120, 30), 30U);  // 30.5: to the even number
    EXPECT_EQ(zoomed_frames(126, 120, 30), 32U);  // 31.5
    EXPECT_EQ(zoomed_frames(1, 120, 30), 0U);
    EXPECT_EQ(zoomed_frames(10, 30, 30), 10U);
}

TEST(Zoom, GoesThroughTheSamplesAndKeepsConstants) {
    for (const std::uint64_t frames : {2, 3, 5, 64, 65, 66, 200}) {
        std::vector<double> samples(frames * 2);
        for (std::uint64_t t = 0; t < frames; ++t) {
            samples[2 * t] = std::sin(0.9 * static_cast<double>(t * t % 17));
            samples[2 * t + 1] = 7;
        }
        const auto same = zoomed(samples, frames, frames);
        for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_NEAR(same[i], samples[i], 1e-13) << frames;
        const auto finer = zoomed(samples, frames, 3 * (frames - 1) + 1);
        for (std::uint64_t t = 0; t < frames; ++t) EXPECT_NEAR(finer[6 * t], samples[2 * t], 1e-12) << frames;
        for (std::size_t i = 1; i < finer.size(); i += 2) EXPECT_NEAR(finer[i], 7, 1e-13);
    }
    EXPECT_NEAR(zoomed(std::vector<double>{3, 4}, 1, 1).at(1), 4, 1e-15);
    EXPECT_TRUE(zoomed(std::vector<double>{3, 4}, 1, 0).empty());
}

TEST(Zoom, IsTheCubicSplineInTheMiddle) {
    // A cubic is its own spline, away from the ends where the mirrored samples are none.
    const std::uint64_t frames = 161;
    std::vector<double> samples(frames);
    const auto cubic = [](double t) { return (t - 80) * (t - 30) * (t - 110) / 1e5; };
    for (std::uint64_t t = 0; t < frames; ++t) samples[t] = cubic(static_cast<double>(t));
    const auto finer = zoomed(samples, frames, 321);
    for (std::size_t i = 120; i < 200; ++i) EXPECT_NEAR(finer[i], cubic(static_cast<double>(i) / 2), 1e-12);
}
