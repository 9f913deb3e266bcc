// Distances against closed forms and the reference program.
#include "eval/metrics/frechet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.hpp"

using namespace actformer;
using eval::fit;
using eval::frechet_distance;

namespace {

std::vector<double> random_samples(std::size_t n, std::size_t dimensions, unsigned seed, double mean = 0) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(mean);
    std::vector<double> out(n * dimensions);
    for (auto& v : out) v = normal(random);
    return out;
}

/// As rows in another order.
std::vector<double> shuffled(const std::vector<double>& samples, std::size_t dimensions, unsigned seed) {
    std::vector<std::size_t> order(samples.size() / dimensions);
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::mt19937 random(seed);
    std::shuffle(order.begin(), order.end(), random);
    std::vector<double> out;
    for (const auto i : order)
        for (std::size_t c = 0; c < dimensions; ++c) out.push_back(samples[i * dimensions + c]);
    return out;
}

/// Turned into twice as many dimensions by (v, v) / sqrt 2, distances stay, and every covariance becomes singular.
std::vector<double> twice(const std::vector<double>& samples, std::size_t dimensions) {
    std::vector<double> out;
    for (std::size_t i = 0; i < samples.size(); i += dimensions)
        for (std::size_t c = 0; c < 2 * dimensions; ++c)
            out.push_back(samples[i + c % dimensions] / std::sqrt(2.0));
    return out;
}

}  // namespace

TEST(Frechet, IsTheDistanceOfMeansAndDeviationsInOneDimension) {
    const std::vector<double> x{1, 2, 6}, y{-4, 4, 8, 12};  // means 3 and 5, variances 7 and 140/3
    EXPECT_NEAR(frechet_distance(fit(x, 1), fit(y, 1)),
                4 + std::pow(std::sqrt(7.0) - std::sqrt(140.0 / 3), 2), 1e-12);
}

TEST(Frechet, AddsUpOverIndependentDimensions) {
    // Samples on the axes, +a and -a on each: a diagonal covariance 2 a^2 / (2d - 1).
    const std::vector<double> a{1, 3, 0.5}, b{2, 0, 4};
    std::vector<double> x, y;
    double expected = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (const double sign : {1.0, -1.0})
            for (std::size_t c = 0; c < 3; ++c) {
                x.push_back(c == i ? sign * a[i] : 0);
                y.push_back((c == i ? sign * b[i] : 0) + 1);
            }
        expected += 1 + 2.0 / 5 * std::pow(a[i] - b[i], 2);
    }
    EXPECT_NEAR(frechet_distance(fit(x, 3), fit(y, 3)), expected, 1e-12);
}

TEST(Frechet, OfTwoPairsOfSamplesIsGivenByTheirDifferences) {
    // One direction each: covariances u u^T / 2 and v v^T / 2, whose cross term is |u.v| / 2.
    const std::vector<double> u{3, 0, 4, 0, 1}, v{1, 2, -2, 0, 5};
    std::vector<double> x(10), y(10);
    for (std::size_t c = 0; c < 5; ++c) x[c] = u[c], y[c] = v[c];
    double uu = 0, vv = 0, uv = 0, means = 0;
    for (std::size_t c = 0; c < 5; ++c) {
        uu += u[c] * u[c], vv += v[c] * v[c], uv += u[c] * v[c];
        means += std::pow((u[c] - v[c]) / 2, 2);
    }
    EXPECT_NEAR(frechet_distance(fit(x, 5), fit(y, 5)), means + uu / 2 + vv / 2 - std::abs(uv), 1e-12);
}

TEST(Frechet, OfTheSameSamplesInAnyOrderIsNothing) {
    for (const std::size_t n : {2U, 3U, 40U, 64U, 65U, 500U, 5000U})
        for (const double mean : {0.0, 100.0}) {
            const auto x = random_samples(n, 64, static_cast<unsigned>(n), mean);
            EXPECT_EQ(frechet_distance(fit(x, 64), fit(x, 64)), 0) << n;
            EXPECT_EQ(frechet_distance(fit(x, 64), fit(shuffled(x, 64, 1), 64)), 0) << n;
        }
}

TEST(Frechet, OfSamplesThatAreAllOneIsTheDistanceOfTheMeans) {
    const std::vector<double> same(5 * 7, 0.25), other(9 * 7, 1.25), spread = random_samples(9, 7, 3);
    EXPECT_EQ(frechet_distance(fit(same, 7), fit(same, 7)), 0);
    EXPECT_NEAR(frechet_distance(fit(same, 7), fit(other, 7)), 7, 1e-12);
    const auto moments = fit(spread, 7);
    double expected = moments.variance;
    for (const double m : moments.mean) expected += (m - 0.25) * (m - 0.25);
    EXPECT_NEAR(frechet_distance(fit(same, 7), moments), expected, 1e-12);
}

TEST(Frechet, IsTheSameBothWaysAndOnAnyNumberOfThreads) {
    const auto x = random_samples(3000, 48, 1), y = random_samples(30, 48, 2, 0.1);
    const auto one = fit(x, 48, 1), four = fit(x, 48, 4);
    EXPECT_EQ(one.factor, four.factor);
    EXPECT_LE(one.factor.size(), std::size_t{2 * 48 * 48}) << "many samples leave few rows";
    const double there = frechet_distance(one, fit(y, 48)), back = frechet_distance(fit(y, 48), one);
    EXPECT_NEAR(there, back, 1e-12 * there);
    EXPECT_GT(there, 0);
}

TEST(Frechet, DoesNotDependOnRepeatedDimensions) {
    constexpr std::pair<std::size_t, std::size_t> few{50, 70}, many{3000, 2500};
    for (const auto& [left, right] : {few, many}) {
        const auto x = random_samples(left, 8, 4), y = random_samples(right, 8, 5, 1);
        const double plain = frechet_distance(fit(x, 8), fit(y, 8));
        EXPECT_NEAR(frechet_distance(fit(twice(x, 8), 16), fit(twice(y, 8), 16)), plain, 1e-11 * plain)
            << left;
    }
}

TEST(Frechet, OfManySamplesIsRightWhateverTheirCondition) {
    // Independent dimensions of scales 1 to 10^-k, samples on the axes as above: diagonal covariances, so that
    // d2 = sum (a_i - b_i)^2 2m / (2dm - 1), and the condition of the samples is 10^k: every way of making a triangle is taken.
    for (const int k : {0, 2, 5, 9, 20}) {
        constexpr std::size_t d = 8, m = 200;
        std::vector<double> x, y;
        double expected = 0, variances = 0;
        for (std::size_t i = 0; i < d; ++i) {
            const double a = std::pow(10.0, -k * static_cast<double>(i) / (d - 1)), b = 1.5 * a;
            for (std::size_t n = 0; n < 2 * m; ++n)
                for (std::size_t c = 0; c < d; ++c) {
                    x.push_back(c == i ? (n % 2 ? a : -a) : 0);
                    y.push_back(c == i ? (n % 2 ? b : -b) : 0);
                }
            const double share = 2.0 * m / (2.0 * d * m - 1);
            expected += share * (a - b) * (a - b);
            variances += share * (a * a + b * b);
        }
        EXPECT_NEAR(frechet_distance(fit(x, d), fit(y, d)), expected, 1e-12 * variances) << k;
    }
}

TEST(Frechet, RefusesWhatHasNoCovariance) {
    EXPECT_THROW(fit(std::vector<double>{1, 2, 3}, 3), Error);
    EXPECT_THROW(fit(std::vector<double>{}, 3), Error);
    EXPECT_THROW(fit(std::vector<double>{1, 2, 3}, 2), Error);
    EXPECT_THROW(fit(std::vector<double>{1, 2, std::nan(""), 3}, 2), Error);
    EXPECT_THROW(fit(std::vector<double>{1, 2, INFINITY, 3}, 2), Error);
    EXPECT_THROW(frechet_distance(fit(std::vector<double>{1, 2}, 1), fit(std::vector<double>{1, 2, 3, 4}, 2)),
                 Error);
}
