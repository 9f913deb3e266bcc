// Diversity and multimodality against closed forms.
#include "eval/metrics/diversity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "eval/metrics/multimodality.hpp"
#include "tests/support/made_samples.hpp"

using actformer::eval::diversity;
using actformer::eval::multimodality;
using actformer::eval::Samples;
using actformer::test::made_samples;

TEST(Diversity, IsTheMeanDistanceOfPairs) {
    Samples corners;  // of a simplex: every pair is sqrt 2 apart; class 1 is twice as large
    corners.dimensions = 10;
    corners.classes = 3;
    for (std::uint32_t i = 0; i < 10; ++i) {
        for (std::uint32_t c = 0; c < 10; ++c) corners.features.push_back(c == i ? (i < 5 ? 1 : 2) : 0);
        corners.labels.push_back(i < 5 ? 0 : 1);
    }
    EXPECT_NEAR(*multimodality(corners), 1.5 * std::sqrt(2.0), 1e-12);
    // all pairs: 10 of class 0, 10 of class 1, 25 across
    const double mean = (10 * std::sqrt(2.0) + 10 * std::sqrt(8.0) + 25 * std::sqrt(5.0)) / 45;
    EXPECT_NEAR(*diversity(corners, 200'000, 3), mean, 0.01) << "ten standard errors of so many pairs";
    EXPECT_EQ(diversity(corners), diversity(corners)) << "the same seed draws the same pairs";
    EXPECT_NE(diversity(corners, 200, 1), diversity(corners, 200, 2));

    // With replacement one pair in five is a sample twice, 0 apart.
    EXPECT_NEAR(*multimodality(corners, 200'000, 3, actformer::eval::PairsDrawn::with_replacement),
                0.8 * 1.5 * std::sqrt(2.0), 0.01);

    const auto single = made_samples({1, 0}, 4, 1);
    EXPECT_FALSE(diversity(single));
    EXPECT_FALSE(multimodality(made_samples({1, 1}, 4, 1)));
    auto lonely = made_samples({5, 1}, 4, 1);
    const auto with = multimodality(lonely);
    lonely.features.resize(5 * 4);
    lonely.logits.clear();
    lonely.labels.resize(5);
    EXPECT_EQ(with, multimodality(lonely)) << "a class of one sample has no pairs";
    const auto pairs = actformer::eval::PairsDrawn::with_replacement;
    EXPECT_EQ(multimodality(made_samples({1, 1}, 4, 1), 20, 0, pairs), 0) << "but itself";
}
