// Conditional batch normalisation: values against the definition, gradients against finite differences, in double.
#include "model/nn/conditional_norm.hpp"

#include <gtest/gtest.h>

#include "tests/support/gradients.hpp"

using namespace actformer::model;
using namespace actformer::test;

namespace {

ConditionalNormTensors norm_of(const at::Tensor& gain, const at::Tensor& shift) {
    const auto channels = gain.size(1);
    return {.gain = gain,
            .shift = shift,
            .mean = at::zeros({channels}, gain.options().requires_grad(false)),
            .variance = at::ones({channels}, gain.options().requires_grad(false)),
            .padding = 1,
            .out_padding = 2};
}

}  // namespace

TEST(ConditionalNorm, NormalisesAChannelOverSamplesNodesAndFrames) {
    at::manual_seed(4);
    const auto x = at::randn({3, 2, 7, 5}, at::kDouble) * 2 + 1, gain = at::randn({3, 5}, at::kDouble),
               shift = at::randn({3, 5}, at::kDouble);
    for (const bool fused : {true, false}) {
        const auto norm = norm_of(gain, shift);
        const auto y = conditional_norm(x, norm, true, fused);
        ASSERT_EQ(y.sizes().vec(), (std::vector<std::int64_t>{3, 2, 9, 5}));
        for (std::int64_t c = 0; c < 5; ++c) {
            const auto inner = x.slice(2, 1, 6).select(3, c);  // the frames on either side are not looked at
            const auto mean = inner.mean(), variance = inner.var(/*unbiased=*/false);
            const auto line = (inner - mean) / (variance + 1e-5).sqrt() * gain.select(1, c).view({3, 1, 1}) +
                              shift.select(1, c).view({3, 1, 1});
            const auto expected = at::where(line > 0, line, line * 0.2);
            EXPECT_TRUE(at::allclose(y.slice(2, 2, 7).select(3, c), expected, 1e-10, 1e-10)) << c;
            EXPECT_NEAR(norm.mean[c].item<double>(), 0.1 * mean.item<double>(), 1e-12);
            EXPECT_NEAR(norm.variance[c].item<double>(), 0.9 + 0.1 * inner.var().item<double>(), 1e-12);
        }
        for (const auto frame : {0, 1, 7, 8}) EXPECT_EQ(y.select(2, frame).abs().max().item<double>(), 0);
    }
}

TEST(ConditionalNorm, GradientsFlowThroughTheStatistics) {
    at::manual_seed(5);
    expect_gradients(
        [](const auto& in) { return conditional_norm(in[0], norm_of(in[1], in[2]), true, true); },
        {random_input({3, 2, 6, 5}), random_input({3, 5}), random_input({3, 5})});
}

TEST(ConditionalNorm, TakesRunningStatisticsOutsideOfTraining) {
    at::manual_seed(6);
    const auto x = at::randn({2, 2, 6, 5}, at::kDouble), gain = at::randn({2, 5}, at::kDouble);
    auto norm = norm_of(gain, at::zeros({2, 5}, at::kDouble));
    norm.mean.fill_(0.5);
    norm.variance.fill_(4);
    for (const bool fused : {true, false}) {
        const auto y = conditional_norm(x, norm, false, fused).slice(2, 2, 6);
        const auto line = (x.slice(2, 1, 5) - 0.5) / std::sqrt(4 + 1e-5) * gain.view({2, 1, 1, 5});
        EXPECT_TRUE(at::allclose(y, at::where(line > 0, line, line * 0.2), 1e-10, 1e-10));
        EXPECT_EQ(norm.mean[0].item<double>(), 0.5) << "nothing moves";
    }
}
