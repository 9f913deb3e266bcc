// KID against its definition in loops, and what it must be of samples from one and from two distributions.
#include "eval/metrics/kid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "tests/support/made_samples.hpp"

using namespace actformer;
using namespace actformer::test;
using eval::Samples;

namespace {

double kernel(const Samples& a, std::size_t i, const Samples& b, std::size_t j) {
    double product = 0;
    for (std::size_t c = 0; c < a.dimensions; ++c) product += features_of(a, i)[c] * features_of(b, j)[c];
    return std::pow(product / static_cast<double>(a.dimensions) + 1, 3);
}

double within(const Samples& a) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < a.size(); ++j)
            if (i != j) sum += kernel(a, i, a, j);
    return sum / static_cast<double>(a.size() * (a.size() - 1));
}

double by_loops(const Samples& a, const Samples& b) {
    double across = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) across += kernel(a, i, b, j);
    return within(a) + within(b) - 2 * across / static_cast<double>(a.size() * b.size());
}

}  // namespace

TEST(Kid, IsTheUnbiasedDiscrepancyOfItsKernel) {
    // More samples than a block, and fewer.
    for (const auto& [real, made] : {std::pair<std::size_t, std::size_t>{300, 40}, {7, 530}, {2, 3}}) {
        const auto a = made_samples({real}, 6, 1), b = made_samples({made}, 6, 2, 1.3F);
        const auto expected = by_loops(a, b);
        // Sums of some 10^5 terms in another order.
        EXPECT_NEAR(*eval::kid(a, b), expected, 1e-10 * (1 + std::abs(within(a)))) << real;
        EXPECT_EQ(*eval::kid(a, b, 1), *eval::kid(a, b, 3)) << "on any threads";
    }
}

TEST(Kid, IsNearZeroWithinADistributionAndAboveItAcrossTwo) {
    double mean = 0;
    for (unsigned seed = 0; seed < 40; ++seed)
        mean += *eval::kid(made_samples({50}, 8, 2 * seed), made_samples({50}, 8, 2 * seed + 1)) / 40;
    const auto apart = *eval::kid(made_samples({50}, 8, 1), made_samples({50}, 8, 2, 2));
    EXPECT_LT(std::abs(mean), 0.1 * apart) << "no bias";
}

TEST(Kid, OfClassesIsTheMeanOfTheirs) {
    const auto real = made_samples({20, 1, 30}, 5, 3), made = made_samples({15, 9, 12}, 5, 4);
    const auto part = [](const Samples& from, std::uint32_t label) {
        Samples out;
        out.dimensions = from.dimensions;
        out.classes = 1;
        for (std::size_t i = 0; i < from.size(); ++i) {
            if (from.labels[i] != label) continue;
            const auto features = features_of(from, i);
            out.features.insert(out.features.end(), features.begin(), features.end());
            out.labels.push_back(0);
        }
        return out;
    };
    const auto expected =
        (by_loops(part(real, 0), part(made, 0)) + by_loops(part(real, 2), part(made, 2))) / 2;
    EXPECT_NEAR(*eval::kid_mean(real, made), expected, 1e-10 * (1 + std::abs(expected)));
    EXPECT_FALSE(eval::kid(made_samples({1}, 5, 1), made));
    EXPECT_FALSE(eval::kid_mean(made_samples({1, 1, 1}, 5, 1), made));
    EXPECT_THROW(eval::kid(made_samples({4}, 6, 1), made), Error);
}
