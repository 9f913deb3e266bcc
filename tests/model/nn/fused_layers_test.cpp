// The recogniser's own layers: values against loops in plain C++, gradients against finite differences, in double.
#include "model/nn/fused_layers.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/gradients.hpp"
#include "tests/support/rounding.hpp"

using namespace actformer::model;
using namespace actformer::test;

namespace {

at::Tensor edges(const std::vector<std::array<int, 3>>& list) {
    auto tensor = at::empty({static_cast<std::int64_t>(list.size()), 3}, at::kInt);
    for (std::size_t e = 0; e < list.size(); ++e)
        for (std::size_t i = 0; i < 3; ++i) tensor.data_ptr<int>()[3 * e + i] = list[e][i];
    return tensor;
}

const std::vector<std::array<int, 3>> chain{{0, 0, 0}, {0, 1, 1}, {0, 2, 2}, {1, 0, 1},
                                            {1, 1, 2}, {2, 1, 0}, {2, 2, 1}};

struct FusedLayers : testing::Test {
    FusedLayers() { at::manual_seed(3); }
};

}  // namespace

TEST_F(FusedLayers, GraphConvolutionSumsOverEdges) {
    const auto x = random_input({2, 5, 3, 7}), strength = random_input({7}), weight = random_input({21, 32}),
               bias = random_input({3, 32});
    const auto y = fused_graph_convolution(x, strength, weight, bias, edges(chain));
    auto expected = bias.unsqueeze(0).unsqueeze(0).repeat({2, 5, 1, 1});
    for (std::size_t e = 0; e < chain.size(); ++e) {
        const auto [part, source, target] = chain[e];
        const auto add = (x.select(2, source) * strength[static_cast<std::int64_t>(e)])
                             .matmul(weight.slice(0, 7 * part, 7 * part + 7));
        expected.select(2, target).add_(add);
    }
    EXPECT_TRUE(at::allclose(y, expected, 1e-10, 1e-10));
}

TEST_F(FusedLayers, GraphConvolutionGradients) {
    const auto list = edges(chain);
    expect_gradients(
        [&](const auto& in) { return fused_graph_convolution(in[0], in[1], in[2], in[3], list); },
        {random_input({2, 5, 3, 7}), random_input({7}), random_input({21, 32}), random_input({3, 32})});
}

TEST_F(FusedLayers, TemporalConvolutionIsTorchs) {
    for (const std::int64_t stride : {1, 2})
        for (const std::int64_t taps : {1, 9})
            for (const std::int64_t frames : {1, 3, 8, 15, 16}) {
                const auto x = random_input({2, frames, 3, 16}), weight = random_input({taps, 16, 48}),
                           bias = random_input({48});
                const auto y = fused_temporal_convolution(x, weight, bias, stride);
                const auto expected =
                    at::conv2d(x.permute({0, 3, 1, 2}), weight.permute({2, 1, 0}).unsqueeze(3), bias,
                               {stride, 1}, {taps / 2, 0});
                EXPECT_TRUE(at::allclose(y, expected.permute({0, 2, 3, 1}), 1e-10, 1e-10))
                    << stride << taps << frames;
            }
}

TEST_F(FusedLayers, TemporalConvolutionGradients) {
    for (const std::int64_t stride : {1, 2})
        for (const std::int64_t taps : {1, 9})
            for (const std::int64_t frames : {3, 8})
                expect_gradients(
                    [&](const auto& in) { return fused_temporal_convolution(in[0], in[1], in[2], stride); },
                    {random_input({3, frames, 3, 16}), random_input({taps, 16, 32}), random_input({32})});
}

TEST_F(FusedLayers, NormIsTorchsAndMovesTheRunningStatistics) {
    const auto x = random_input({4, 5, 3, 16}), weight = random_input({16}), bias = random_input({16}),
               shortcut = random_input({4, 5, 3, 16});
    auto mean = at::randn({16}, at::kDouble), variance = at::rand({16}, at::kDouble) + 0.5;
    auto torch_mean = mean.clone(), torch_variance = variance.clone();
    for (const bool training : {true, false}) {
        const auto y = fused_norm(x, {weight, bias, mean, variance}, {true, 0, 0}, shortcut, training);
        const auto normal = at::batch_norm(x.permute({0, 3, 1, 2}), weight, bias, torch_mean, torch_variance,
                                           training, 0.1, 1e-5, true);
        EXPECT_TRUE(at::allclose(y, (normal.permute({0, 2, 3, 1}) + shortcut).relu(), 1e-8, 1e-9))
            << training;
        EXPECT_TRUE(at::allclose(mean, torch_mean, 1e-10, 1e-10));
        EXPECT_TRUE(at::allclose(variance, torch_variance, 1e-10, 1e-10));
    }
}

TEST_F(FusedLayers, NormGradients) {
    for (const bool relu : {true, false})
        for (const double drop : {0.0, 0.4})
            for (const bool add : {true, false}) {
                if (add && !relu) continue;  // a shortcut is always followed by ReLU
                const auto mean = at::zeros({16}, at::kDouble), variance = at::ones({16}, at::kDouble);
                expect_gradients(
                    [&](const auto& in) {
                        return fused_norm(in[0], {in[1], in[2], mean, variance}, {relu, drop, 12345},
                                          add ? in[3] : at::Tensor(), true);
                    },
                    add ? std::vector<at::Tensor>{random_input({4, 5, 3, 16}), random_input({16}),
                                                  random_input({16}), random_input({4, 5, 3, 16})}
                        : std::vector<at::Tensor>{random_input({4, 5, 3, 16}), random_input({16}),
                                                  random_input({16})});
            }
}

TEST_F(FusedLayers, NormKeepsASmallSpreadAboutALargeMean) {
    const auto x = at::randn({8, 10, 5, 16}, at::kFloat) * 0.01 + 100;
    auto mean = at::zeros({16}), variance = at::ones({16});
    const auto y = fused_norm(x.contiguous(), {at::ones({16}), at::zeros({16}), mean, variance},
                              {false, 0, 0}, {}, true);
    const auto spread = y.view({-1, 16}).std(0, false);
    EXPECT_TRUE(at::allclose(spread, at::full({16}, std::sqrt(1e-4 / (1e-4 + 1e-5))), 0.03, 0));
}

// Summed in a row, the 576 products of an output, the 1,920 of a weight's gradient and the 192 of the graph came to 7.1, 11.1 and
// 2.7 units, a mean folded into the bias to 13.0; in short sums that are then added up they come to 2.2, 1.8, 1.9 and 9.7.
TEST_F(FusedLayers, Float32RoundsAsShortSumsDo) {
    const auto as_double = [](std::vector<at::Tensor> in) {
        for (auto& t : in) t = t.to(at::kDouble);
        return in;
    };
    const auto rounding_of = [&](const std::vector<at::Tensor>& in, const auto& layer) {
        return rounding(layer(in), layer(as_double(in)));
    };
    const auto x = at::randn({4, 40, 12, 64});
    const std::vector<at::Tensor> temporal{x, at::randn({9, 64, 64}), at::randn({64})};
    EXPECT_LT(rounding_of(temporal,
                          [](const auto& in) { return fused_temporal_convolution(in[0], in[1], in[2], 1); }),
              2.6);
    EXPECT_LT(rounding_of(temporal,
                          [](const auto& in) {
                              const auto weight = in[1].detach().clone().set_requires_grad(true);
                              fused_temporal_convolution(in[0], weight, in[2], 1).backward(in[0]);
                              return weight.grad();
                          }),
              2.3);
    EXPECT_LT(
        rounding_of(
            {x.slice(2, 0, 3).contiguous(), at::randn({7}), at::randn({192, 64}), at::randn({3, 64})},
            [](const auto& in) { return fused_graph_convolution(in[0], in[1], in[2], in[3], edges(chain)); }),
        2.3);
    EXPECT_LT(rounding_of({x + 30, at::ones({64}), at::zeros({64})},
                          [](const auto& in) {
                              return fused_norm(in[0], {in[1], in[2], in[2].clone(), in[1].clone()},
                                                {false, 0, 0}, {}, true);
                          }),
              11.5);
}

TEST_F(FusedLayers, DropoutDropsItsShareByItsSeed) {
    const auto x = at::randn({16, 20, 5, 16});
    auto mean = at::zeros({16}), variance = at::ones({16});
    const auto dropped = [&](std::uint64_t seed) {
        return fused_norm(x, {at::ones({16}), at::full({16}, 50.0), mean, variance}, {false, 0.3, seed}, {},
                          true)
            .eq(0);
    };
    const auto first = dropped(1);
    EXPECT_NEAR(first.to(at::kDouble).mean().item<double>(), 0.3, 0.015);
    EXPECT_TRUE(first.equal(dropped(1)));
    const auto agree = [&](std::uint64_t seed) {
        return first.eq(dropped(seed)).to(at::kDouble).mean().item<double>();
    };
    EXPECT_NEAR(agree(2), 0.58, 0.02);  // 0.3 * 0.3 + 0.7 * 0.7: the masks have nothing to do with each other
    EXPECT_NEAR(agree(std::uint64_t{1} << 40), 0.58, 0.02);
    const auto over_channels = first.view({-1, 16}).to(at::kDouble).mean(0);
    EXPECT_NEAR(over_channels.min().item<double>(), 0.3, 0.06);
    EXPECT_NEAR(over_channels.max().item<double>(), 0.3, 0.06);
}
