// The loss that keeps a class's motions apart, against sums by hand and differences.
#include <ATen/ATen.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/generators/adversarial/spread.hpp"

using namespace actformer::model;

namespace {

/// Motions of one number a node and frame, (batch, 1, 2, 1), all frames alike.
at::Tensor motions(const std::vector<float>& numbers) {
    const auto count = static_cast<std::int64_t>(numbers.size());
    return at::tensor(numbers).view({count, 1, 1, 1}).expand({count, 1, 2, 1}).contiguous();
}

const auto labels = at::tensor(std::vector<std::int64_t>{1, 0, 1, 0, 1, 2});

}  // namespace

TEST(ClassSpread, IsTheMeanDistanceToTheNextOfTheClass) {
    // class 0: |3 - 10|; class 1: |1 - 2|, |2 - 8|; class 2 has one
    const auto spread = class_spread(motions({1, 3, 2, 10, 8, 100}), labels);
    EXPECT_EQ(spread.sizes(), (at::IntArrayRef{1, 1}));
    EXPECT_FLOAT_EQ(spread.item<float>(), (7 + 1 + 6) / 3.0F);
}

TEST(ClassSpread, OfNoPairsIsZero) {
    const auto apart = at::tensor(std::vector<std::int64_t>{4, 2, 7});
    EXPECT_EQ(class_spread(motions({1, 3, 2}), apart).item<float>(), 0);
    EXPECT_EQ(class_spread(motions({1}), apart.narrow(0, 0, 1)).item<float>(), 0);
    EXPECT_EQ(spread_loss(motions({1, 3, 2}), motions({0, 0, 0}), apart).item<float>(), 0);
}

TEST(SpreadLoss, IsTheLogarithmOfHowMuchCloserFakeMotionsAre) {
    const auto real = motions({1, 3, 2, 10, 8, 100});
    const auto loss = [&](double scale) { return spread_loss(real, real * scale, labels).item<double>(); };
    const double spread = 14 / 3.0, least = 1e-3;
    EXPECT_EQ(loss(1), 0);
    EXPECT_EQ(loss(3), 0) << "further apart than real ones is no fault";
    // float32 logarithms of numbers near 1: some units of 6e-8
    EXPECT_NEAR(loss(0.5), std::log((spread + least) / (spread / 2 + least)), 1e-6);
    EXPECT_NEAR(loss(0), std::log((spread + least) / least), 2e-6);
}

TEST(SpreadLoss, HasTheGradientOfDifferences) {
    const auto real = at::randn({6, 3, 4, 2}), fake = (at::randn({6, 3, 4, 2}) * 0.3).requires_grad_(true);
    spread_loss(real, fake, labels).backward();
    const auto direction = at::randn({6, 3, 4, 2});
    const auto at = [&](double step) {
        return spread_loss(real, fake.detach() + step * direction, labels).item<double>();
    };
    // float32 losses of about 1 are good to 1e-7, so differences over 2e-3 to 1e-4
    const double step = 1e-3, along = (fake.grad() * direction).sum().item<double>();
    EXPECT_NEAR((at(step) - at(-step)) / (2 * step), along, 2e-3 * std::max(1.0, std::abs(along)));
}
