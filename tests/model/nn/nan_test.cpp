// NaN stays NaN in the fused layers: a diverged training shows in its losses.
#include <gtest/gtest.h>

#include <limits>

#include "model/nn/conditional_norm.hpp"
#include "model/nn/fused_gru.hpp"
#include "model/nn/fused_layers.hpp"
#include "model/nn/fused_post_norm.hpp"

using namespace actformer::model;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

struct NotANumber : testing::TestWithParam<at::ScalarType> {
    at::Tensor random(at::IntArrayRef shape) const {
        return at::randn(shape, at::TensorOptions(GetParam())) * 0.3;
    }
    at::Tensor all(at::IntArrayRef shape, double value) const {
        return at::full(shape, value, at::TensorOptions(GetParam()));
    }
    LinearTensors linear(std::int64_t out, std::int64_t in) const {
        return {random({out, in}), random({out})};
    }
    LinearTensors norm(std::int64_t width) const { return {all({width}, 1), all({width}, 0)}; }
};

LinearTensors broken(LinearTensors linear) {
    linear.bias.fill_(not_a_number);
    return linear;
}

void expect_all_nan(const at::Tensor& x) {
    EXPECT_TRUE(at::isnan(x).all().item<bool>()) << x;
}

}  // namespace

TEST_P(NotANumber, StaysInReLU) {
    auto x = random({4, 5, 3, 16});
    x[0][0][0][2] = not_a_number;
    for (const bool training : {true, false}) {
        auto mean = all({16}, 0), variance = all({16}, 1);
        const auto y =
            fused_norm(x, {all({16}, 1), all({16}, 0), mean, variance}, {true, 0, 0}, {}, training);
        expect_all_nan(y[0][0][0][2]);
        EXPECT_FALSE(at::isnan(y.select(3, 1)).any().item<bool>()) << "another channel";
        if (!training) continue;
        expect_all_nan(y.select(3, 2));
        expect_all_nan(mean[2]);
        expect_all_nan(variance[2]);
    }
}

TEST_P(NotANumber, StaysInLeakyReLU) {
    auto x = random({2, 3, 4, 16});
    x[0][0][0][2] = not_a_number;
    auto mean = all({16}, 0), variance = all({16}, 1);
    const auto y = conditional_norm(x, {all({2, 16}, 1), all({2, 16}, 0), mean, variance}, true, true);
    expect_all_nan(y.select(3, 2));
    expect_all_nan(variance[2]);
}

TEST_P(NotANumber, StaysInGelu) {
    const auto x = random({2, 1, 5, 32});
    expect_all_nan(fused_mlp(x, norm(32), broken(linear(64, 32)), linear(32, 64)));
    expect_all_nan(
        fused_mlp_norm(x.squeeze(1), broken(linear(64, 32)), linear(32, 64), {norm(32), 1e-5}, {}));
}

TEST_P(NotANumber, StaysInSoftmax) {
    for (const bool over_persons : {true, false}) {
        const auto x = random({2, 2, 20, 32});
        auto qkv = linear(96, 32);
        qkv.bias.slice(0, 0, 64).fill_(not_a_number);  // queries and keys
        expect_all_nan(fused_attention(x, norm(32), qkv, linear(32, 32), 4, over_persons));
    }
}

TEST_P(NotANumber, StaysInTheGatesOfAGru) {
    const std::int64_t hidden = 16, samples = 3, frames = 2;
    for (const std::int64_t gate : {0, 1, 2}) {
        const GruInputs inputs{random({frames, samples, 3 * hidden}), random({samples, 3 * hidden}),
                               random({frames, 3 * hidden})};
        inputs.products.slice(2, gate * hidden, (gate + 1) * hidden).fill_(not_a_number);
        expect_all_nan(fused_gru(inputs, {{{}, linear(3 * hidden, hidden)}}));
    }
}

TEST_P(NotANumber, StaysInPoses) {
    const auto x = random({2, 1, 6, 20});
    for (const auto how : actformer::ingest::Representation::all()) {
        const std::int64_t numbers = how.numbers();
        const auto y = fused_poses(x, norm(20), broken(linear(9 * numbers, 20)), how);
        expect_all_nan(how == actformer::ingest::Representation::rot6d ? y.slice(3, 0, 8) : y);
    }
}

INSTANTIATE_TEST_SUITE_P(Types, NotANumber, testing::Values(at::kFloat, at::kDouble),
                         [](const auto& type) { return std::string(at::toString(type.param)); });
