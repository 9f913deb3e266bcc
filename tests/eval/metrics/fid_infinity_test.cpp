// FIDs extrapolated to infinitely many samples: the line's closed form, and Gaussians whose distance is known.
#include "eval/metrics/fid_infinity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "eval/metrics/fid.hpp"
#include "tests/support/made_samples.hpp"

using namespace actformer::test;
using namespace actformer::eval;

TEST(FidInfinity, TheLineMeetsZeroWhereItShould) {
    const std::array<double, 4> x{1, 2, 3, 5}, line{5, 7, 9, 13}, scattered{1, 3, 2, 7};
    EXPECT_NEAR(intercept(x, line), 3, 1e-12);
    // Normal equations by hand: means 2.75 and 3.25, sums of products 12.25 and of squares 8.75.
    EXPECT_NEAR(intercept(x, scattered), 3.25 - 12.25 / 8.75 * 2.75, 1e-12);
}

TEST(FidInfinity, TakesTheBiasOfFewSamplesAway) {
    // Both sides from one distribution: a FID of 0 but for the number of samples.
    double plain = 0, extrapolated = 0, plain_mean = 0, extrapolated_mean = 0;
    for (unsigned seed = 0; seed < 5; ++seed) {
        const auto a = made_samples({200, 160}, 6, 2 * seed), b = made_samples({200, 160}, 6, 2 * seed + 1);
        const auto measured = distances(statistics_of(a), statistics_of(b));
        const auto found = fid_infinity(a, b, seed);
        ASSERT_TRUE(found && found->mean);
        plain += measured.whole / 5;
        plain_mean += *measured.mean / 5;
        extrapolated += found->whole / 5;
        extrapolated_mean += *found->mean / 5;
        EXPECT_EQ(found->whole, fid_infinity(a, b, seed, 1)->whole) << "on any threads";
    }
    EXPECT_LT(std::abs(extrapolated), plain / 2);
    EXPECT_LT(std::abs(extrapolated_mean), plain_mean / 2);
}

TEST(FidInfinity, KeepsADistanceThatIsThere) {
    // Deviations 1 and 3 in 4 dimensions, the same mean: 4 (3 - 1)^2 = 16.
    const auto found = fid_infinity(made_samples({2000}, 4, 1), made_samples({2000}, 4, 2, 3));
    EXPECT_NEAR(found->whole, 16, 1.5);
}

TEST(FidInfinity, LeavesThinClassesOut) {
    const auto real = made_samples({40, 7}, 3, 1), made = made_samples({40, 40}, 3, 2);
    EXPECT_TRUE(fid_infinity(real, made)->mean) << "class 1 has one sample in the smallest subset";
    EXPECT_FALSE(fid_infinity(made_samples({7}, 3, 1), made_samples({40}, 3, 2)));
    EXPECT_FALSE(fid_infinity(made_samples({4, 4}, 3, 1), made)->mean);
}

TEST(FidInfinity, OfFewSamplesGoesByTheSharesThatAreTaken) {
    // Ten samples of a normal distribution on each side, of which subsets take 10 6 5 4 3 2 2. Over 3,000 draws in NumPy the FID is 0.303 on
    // average; extrapolated by the shares taken -0.081, by 1 to 4 as if ten could be divided by them -0.303, each within 0.02.
    double whole = 0, mean = 0;
    constexpr unsigned draws = 2000;
    for (unsigned seed = 0; seed < draws; ++seed) {
        const auto found =
            fid_infinity(made_samples({10}, 1, 2 * seed), made_samples({10}, 1, 2 * seed + 1), seed, 1);
        whole += found->whole / draws;
        mean += *found->mean / draws;
    }
    EXPECT_NEAR(whole, -0.081, 0.1);
    EXPECT_NEAR(mean, whole, 1e-9) << "one class is all there is";
}
