// The layers of ActFormer on processors: gradients against finite differences and values against libtorch's operators, in
// double, where sums of up to some thousand products differ from the other order's by less than 1e-9.
#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>
#include <gtest/gtest.h>

#include "model/generators/graph/coarsening.hpp"
#include "model/nn/fused.hpp"
#include "tests/support/gradients.hpp"
#include "tests/support/rounding.hpp"
#include "tests/support/tensors.hpp"

using namespace actformer::model;
using namespace actformer::test;

namespace {

LinearTensors random_norm(std::int64_t width) {
    return {random_input({width}), random_input({width})};
}

LinearTensors random_linear(std::int64_t out, std::int64_t in) {
    return {random_input({out, in}, 0.3), random_input({out})};
}

at::Tensor norm_of(const at::Tensor& x, const LinearTensors& norm) {
    return at::layer_norm(x, {x.size(-1)}, norm.weight, norm.bias, 1e-6);
}

at::Tensor plain_attention(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& qkv,
                           const LinearTensors& proj, std::int64_t heads, bool over_persons) {
    const auto turned = over_persons ? x.transpose(1, 2) : x;
    const auto a = turned.size(0), b = turned.size(1), c = turned.size(2), width = turned.size(3);
    const auto all = at::linear(norm_of(turned, norm), qkv.weight, qkv.bias)
                         .view({a, b, c, 3, heads, width / heads})
                         .permute({3, 0, 1, 4, 2, 5});
    const auto scores =
        all[0].matmul(all[1].transpose(-1, -2)) / std::sqrt(static_cast<double>(width / heads));
    const auto seen = scores.softmax(-1).matmul(all[2]).transpose(2, 3).reshape({a, b, c, width});
    const auto y = turned + at::linear(seen, proj.weight, proj.bias);
    return over_persons ? y.transpose(1, 2) : y;
}

struct ActformerLayers : testing::Test {
    ActformerLayers() { at::manual_seed(5); }
};

/// A path of four nodes of which the inner two are kept; node 0 and 3 reach them at one hop.
HopMatrix some_sums() {
    return hop_matrix(graph_of_tree({-1, 0, 1, 2}), {1, 2});
}

std::shared_ptr<const cpu::NodeSums> groups_of(const HopMatrix& sums) {
    return std::make_shared<cpu::NodeSums>(sums.hops, sums.outputs, sums.inputs, sums.values);
}

cpu::NodeShape node_shape(const HopMatrix& sums, std::int64_t samples, std::int64_t frames, std::int64_t in,
                          std::int64_t out, std::int64_t taps, std::int64_t stride, std::int64_t padding) {
    return cpu::NodeShape{.samples = samples,
                          .frames = frames,
                          .in_nodes = sums.inputs,
                          .out_nodes = sums.outputs,
                          .in = in,
                          .out = out,
                          .taps = taps,
                          .stride = stride,
                          .padding = padding,
                          .out_padding = 1}
        .with_weights_by_node(2);
}

/// Zeros on either side of the frames.
at::Tensor with_padding(const at::Tensor& x, std::int64_t padding) {
    return at::constant_pad_nd(x, {0, 0, padding, padding});
}

at::Tensor plain_node_convolution(const at::Tensor& x, const at::Tensor& weight, const at::Tensor& bias,
                                  const HopMatrix& sums, std::int64_t stride, std::int64_t padding) {
    std::vector<at::Tensor> outputs;
    for (std::uint32_t w = 0; w < sums.outputs; ++w) {
        at::Tensor y;
        for (std::uint32_t v = 0; v < sums.inputs; ++v)
            for (std::uint32_t hop = 0; hop < 2; ++hop) {
                const auto here = at::conv1d(x.select(1, v).transpose(1, 2), weight[v][hop].transpose(1, 2),
                                             {}, stride, padding);
                const auto part = here * static_cast<double>(sums.at(hop, w, v));
                y = y.defined() ? y + part : part;
            }
        outputs.push_back(at::leaky_relu(y.transpose(1, 2) + bias[w], 0.2));
    }
    return at::stack(outputs, 1);
}

}  // namespace

TEST_F(ActformerLayers, EmbeddingIsTokensPlusPositions) {
    for (const std::int64_t streams : {1, 3}) {
        const auto latent = at::randn({4, streams, 6, 5}, at::kDouble);
        const auto linear = random_linear(14, 5);
        const auto classes = random_input({4, 14}), positions = random_input({7, 3, 14});
        const auto y = fused_embedding(latent, linear, classes, positions);
        const auto frames = at::linear(latent, linear.weight, linear.bias).expand({4, 3, 6, 14});
        const auto first = classes.view({4, 1, 1, 14}).expand({4, 3, 1, 14});
        expect_near(y, at::cat({first, frames}, 2) + positions.transpose(0, 1), 1e-12);
        expect_gradients(
            [&](const auto& in) {
                return fused_embedding(latent, {in[0], in[1]}, in[2], in[3]);
            },
            {linear.weight, linear.bias, classes, positions});
    }
}

TEST_F(ActformerLayers, AttentionOverShortAndLongSequences) {
    for (const bool over_persons : {true, false})
        for (const std::int64_t tokens : {3, 19}) {
            const auto x = random_input({2, 3, tokens, 20});
            const auto norm = random_norm(20), qkv = random_linear(60, 20), proj = random_linear(20, 20);
            const auto y = fused_attention(x, norm, qkv, proj, 4, over_persons);
            expect_near(y, plain_attention(x, norm, qkv, proj, 4, over_persons), 1e-12);
            {
                const at::NoGradGuard no_gradients;
                const auto in_place = x.clone();
                expect_near(fused_attention(in_place, norm, qkv, proj, 4, over_persons), y, 1e-12);
            }
            expect_gradients(
                [&](const auto& in) {
                    return fused_attention(in[0], {in[1], in[2]}, {in[3], in[4]}, {in[5], in[6]}, 4,
                                           over_persons);
                },
                {x, norm.weight, norm.bias, qkv.weight, qkv.bias, proj.weight, proj.bias});
        }
}

TEST_F(ActformerLayers, AttentionOfAFloatIsThatOfADouble) {
    // Widths and lengths of the paper: heads of 25 numbers, 61 tokens. Sums of 200 products in float differ by some 1e-5.
    const auto x = random_input({3, 2, 61, 200});
    const auto norm = random_norm(200), qkv = random_linear(600, 200), proj = random_linear(200, 200);
    const auto as_float = [](const LinearTensors& l) {
        return LinearTensors{l.weight.to(at::kFloat), l.bias.to(at::kFloat)};
    };
    for (const bool over_persons : {true, false}) {
        const auto exact = fused_attention(x, norm, qkv, proj, 8, over_persons);
        const auto rounded =
            fused_attention(x.to(at::kFloat), as_float(norm), as_float(qkv), as_float(proj), 8, over_persons);
        expect_near(rounded.to(at::kDouble), exact, 1e-4);
    }
}

TEST_F(ActformerLayers, Mlp) {
    const auto x = random_input({3, 2, 7, 12});
    const auto norm = random_norm(12), up = random_linear(22, 12), down = random_linear(12, 22);
    const auto y = fused_mlp(x, norm, up, down);
    const auto inner = at::gelu(at::linear(norm_of(x, norm), up.weight, up.bias));
    expect_near(y, x + at::linear(inner, down.weight, down.bias), 1e-12);
    expect_gradients(
        [&](const auto& in) {
            return fused_mlp(in[0], {in[1], in[2]}, {in[3], in[4]}, {in[5], in[6]});
        },
        {x, norm.weight, norm.bias, up.weight, up.bias, down.weight, down.bias});
    const auto rounded = [](const at::Tensor& t) { return t.detach().to(at::kFloat); };
    const auto in_float =
        fused_mlp(rounded(x), {rounded(norm.weight), rounded(norm.bias)},
                  {rounded(up.weight), rounded(up.bias)}, {rounded(down.weight), rounded(down.bias)});
    expect_near(in_float.to(at::kDouble), y, 2e-6);  // GELU's approximation in float is within 1e-7
}

// Summed in a row over all 4,920 tokens, gradients to weights came to 21 units; a sample's 82 at a time they come to 4.8.
TEST_F(ActformerLayers, Float32RoundsAsShortSumsDo) {
    const auto x = at::randn({60, 2, 41, 32}), probe = at::randn_like(x);
    const auto up = at::randn({48, 32}) * 0.2, down = at::randn({32, 48}) * 0.2;
    const auto gradients = [&](at::ScalarType type) {
        const at::TensorOptions options(type);
        const auto to_up = up.to(type).clone().set_requires_grad(true),
                   to_down = down.to(type).clone().set_requires_grad(true);
        fused_mlp(x.to(type), {at::ones({32}, options), at::zeros({32}, options)},
                  {to_up, at::zeros({48}, options)}, {to_down, at::zeros({32}, options)})
            .backward(probe.to(type));
        return at::cat({to_up.grad().view(-1), to_down.grad().view(-1)});
    };
    EXPECT_LT(rounding(gradients(at::kFloat), gradients(at::kDouble)), 6);
}

namespace {

/// Raw numbers (N, P, T, K, D) of every node but the free one, through tanh, in libtorch's operators.
at::Tensor plain_finish(const at::Tensor& raw, actformer::ingest::Representation how) {
    const auto bounded = raw.tanh();
    const auto length = [](const at::Tensor& v) { return v.norm(2, {-1}, true); };
    if (how == actformer::ingest::Representation::limb) return bounded / (length(bounded) + 1e-4);
    const auto a = bounded.slice(4, 0, 3), b = bounded.slice(4, 3, 6);
    const auto first = a / length(a), rest = b - (b * first).sum(4, true) * first;
    return at::cat({first, rest / length(rest)}, 4);
}

/// The same with the free node's position beside 0, and persons and numbers together, (N, P*D, T, K).
at::Tensor plain_poses(const at::Tensor& x, const LinearTensors& norm, const LinearTensors& head,
                       actformer::ingest::Representation how) {
    const auto n = x.size(0), p = x.size(1), t = x.size(2) - 1, d = std::int64_t{how.numbers()},
               k = head.weight.size(0) / d;
    const auto raw = at::linear(norm_of(x, norm).slice(2, 1), head.weight, head.bias).view({n, p, t, k, d});
    auto motion = raw;
    if (how != actformer::ingest::Representation::xyz) {
        const std::int64_t free = how.free_node(static_cast<std::uint32_t>(k)).value();
        const auto finished = plain_finish(raw, how);
        const auto position = raw.slice(3, free, free + 1).slice(4, 0, 3);
        motion = at::cat(
            {finished.slice(3, 0, free), at::cat({position, at::zeros({n, p, t, 1, d - 3}, x.options())}, 4),
             finished.slice(3, free + 1)},
            3);
    }
    return motion.permute({0, 1, 4, 2, 3}).reshape({n, p * d, t, k});
}

}  // namespace

TEST_F(ActformerLayers, PosesAreFinishedAsTheirRepresentationHasThem) {
    for (const auto how : actformer::ingest::Representation::all()) {
        constexpr std::int64_t nodes = 19;  // no multiple of any vector's length
        const auto x = random_input({2, 2, 6, 20});
        const auto norm = random_norm(20), head = random_linear(nodes * how.numbers(), 20);
        const auto y = fused_poses(x, norm, head, how);
        expect_near(y, plain_poses(x, norm, head, how), 1e-12);
        {
            const at::NoGradGuard no_gradients;
            expect_near(fused_poses(x, norm, head, how), y, 0);
        }
        expect_gradients(
            [&](const auto& in) {
                return fused_poses(in[0], {in[1], in[2]}, {in[3], in[4]}, how);
            },
            {x, norm.weight, norm.bias, head.weight, head.bias});
    }
}

TEST_F(ActformerLayers, PosesAreFiniteWhereADirectionIsLost) {
    // All numbers of a node 0, and for rotations a second row along the first.
    for (const auto how : actformer::ingest::Representation::all()) {
        const auto d = std::int64_t{how.numbers()};
        const auto x = random_input({1, 1, 4, 20});
        auto weight = at::zeros({9 * d, 20}, at::kDouble), bias = at::zeros({9 * d}, at::kDouble);
        if (d == 6) bias.slice(0, 6, 12).copy_(at::tensor({1.0, 2.0, 3.0, 1.0, 2.0, 3.0}, at::kDouble));
        weight.set_requires_grad(true);
        bias.set_requires_grad(true);
        const auto y = fused_poses(x, random_norm(20), {weight, bias}, how);
        EXPECT_TRUE(at::isfinite(y).all().item<bool>()) << how.name();
        y.square().sum().backward();
        EXPECT_TRUE(at::isfinite(bias.grad()).all().item<bool>()) << how.name();
        EXPECT_TRUE(at::isfinite(weight.grad()).all().item<bool>()) << how.name();
    }
}

TEST_F(ActformerLayers, MotionInputAppendsDifferences) {
    const auto motion = random_input({2, 4, 6, 5});
    const auto y = fused_motion_input(motion, 2);
    const auto moved = motion.slice(2, 1) - motion.slice(2, 0, 5);
    const auto still = at::zeros({2, 4, 1, 5}, at::kDouble);
    const auto both = at::cat({motion, at::cat({still, moved}, 2)}, 1).permute({0, 3, 2, 1});
    expect_near(y, with_padding(both, 2), 1e-14);
    expect_gradients([&](const auto& in) { return fused_motion_input(in[0], 2); }, {motion});
}

TEST_F(ActformerLayers, NodeConvolutionSumsOverHopsAndNodes) {
    const auto sums = some_sums();
    const auto groups = groups_of(sums);
    EXPECT_EQ(groups->groups.size(), 6U);  // at no hop nodes 1 and 2, at one hop all four
    for (const std::int64_t stride : {1, 2}) {
        const std::int64_t taps = stride == 1 ? 5 : 4, padding = stride == 1 ? 2 : 1;
        const auto x = random_input({3, 4, 9, 6}), weight = random_input({4, 2, 18, taps, 6}),
                   bias = random_input({2, 18});
        const auto shape = node_shape(sums, 3, 9, 6, 18, taps, stride, padding);
        const auto y = fused_node_convolution(with_padding(x, padding), weight, bias, shape, groups, 0.2);
        expect_near(y, with_padding(plain_node_convolution(x, weight, bias, sums, stride, padding), 1),
                    1e-12);
        expect_gradients(
            [&](const auto& in) {
                return fused_node_convolution(with_padding(in[0], padding), in[1], in[2], shape, groups, 0.2);
            },
            {x, weight, bias});
    }
}

TEST_F(ActformerLayers, WeightsThatFeedNothingHaveNoGradient) {
    const auto sums = some_sums();
    const auto groups = groups_of(sums);
    const auto x = at::randn({2, 4, 9 + 2, 6}, at::kDouble), weight = random_input({4, 2, 8, 4, 6});
    fused_node_convolution(x, weight, {}, node_shape(sums, 2, 9, 6, 8, 4, 2, 1), groups, 0.2)
        .sum()
        .backward();
    EXPECT_EQ(weight.grad()[0][0].abs().max().item<double>(), 0);
    EXPECT_EQ(weight.grad()[3][0].abs().max().item<double>(), 0);
    EXPECT_GT(weight.grad()[3][1].abs().max().item<double>(), 0);
}

TEST_F(ActformerLayers, SpectralNormGradientsHoldTheVectors) {
    const auto weight = random_input({7, 2, 5}), u = at::randn({7}, at::kDouble),
               v = at::randn({10}, at::kDouble);
    const auto y = fused_spectral(weight, u, v, false);
    expect_near(y, weight / at::dot(u, weight.view({7, 10}).mv(v)), 1e-12);
    expect_gradients([&](const auto& in) { return fused_spectral(in[0], u, v, false); }, {weight});
}

TEST_F(ActformerLayers, PowerIterationsFindTheLargestSingularValue) {
    const auto weight = at::randn({40, 3, 11}, at::kDouble);
    auto u = at::randn({40}, at::kDouble), v = at::randn({33}, at::kDouble);
    at::Tensor y;
    for (int i = 0; i < 300; ++i) y = fused_spectral(weight, u, v, true);
    const auto largest = std::get<1>(at::linalg_svd(weight.view({40, 33}), false)).max().item<double>();
    expect_near(y, weight / largest, 1e-9);
    EXPECT_NEAR(u.norm().item<double>(), 1, 1e-12);
    EXPECT_NEAR(v.norm().item<double>(), 1, 1e-12);
    const auto kept = u.clone();
    fused_spectral(weight, u, v, false);
    EXPECT_TRUE(u.equal(kept));
}

TEST_F(ActformerLayers, ThreadsShareTheWork) {
    const int before = at::get_num_threads();
    const auto x = random_input({5, 2, 9, 12}), weight = random_input({4, 2, 18, 4, 6}),
               motion = random_input({5, 4, 11, 6});
    const auto norm = random_norm(12), qkv = random_linear(36, 12), proj = random_linear(12, 12);
    const auto sums = some_sums();
    const auto groups = groups_of(sums);
    std::vector<at::Tensor> first;
    for (const int threads : {1, 3}) {
        at::set_num_threads(threads);
        for (const auto& t : {x, weight, norm.weight, qkv.weight, qkv.bias, proj.weight})
            t.mutable_grad().reset();
        (fused_attention(x, norm, qkv, proj, 4, false).square().sum() +
         fused_node_convolution(motion, weight, {}, node_shape(sums, 5, 9, 6, 18, 4, 2, 1), groups, 0.2)
             .square()
             .sum())
            .backward();
        std::vector<at::Tensor> now;
        for (const auto& t : {x, weight, norm.weight, qkv.weight, qkv.bias, proj.weight})
            now.push_back(t.grad().clone());
        for (std::size_t i = 0; i < first.size(); ++i) expect_near(now[i], first[i], 1e-12);
        first = now;
    }
    at::set_num_threads(before);
}
