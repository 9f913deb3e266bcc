// Adam beside its formula in double, and parameters that lie end to end.
#include "model/nn/adam.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace actformer::model;

namespace {

std::vector<at::Tensor> parameters() {
    auto a = at::linspace(-1, 1, 21, at::kFloat).view({3, 7}), b = at::full({5}, 0.5, at::kFloat);
    a.set_requires_grad(true);
    b.set_requires_grad(true);
    return {a, b};
}

void backward(const std::vector<at::Tensor>& p) {
    ((p[0] * p[0] * p[0]).sum() + (p[1] * 3).sum() * p[0].sum()).backward();
}

}  // namespace

TEST(FlatParameters, StayTheTensorsTheyWere) {
    auto p = parameters(), plain = parameters();
    FlatParameters flat(p, 2);
    flat.zero_gradients();
    backward(p);
    backward(plain);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(p[i].equal(plain[i]));
        EXPECT_TRUE(p[i].grad().equal(plain[i].grad()));
        EXPECT_EQ(p[i].grad().storage().data(), flat.gradients().storage().data());
    }
    EXPECT_EQ(flat.all_reduce_buffer().numel(), flat.gradients().numel() + 2);
    backward(p);  // adds
    EXPECT_TRUE(p[1].grad().equal(2 * plain[1].grad()));
    flat.want_gradients(false);
    EXPECT_FALSE((p[0] * 2).requires_grad());
}

TEST(Adam, FollowsItsFormula) {
    struct Case {
        double beta1, decay;
    };
    for (const auto [beta1, decay] : {Case{0.0, 0}, Case{0.9, 0}, Case{0.9, 0.5}}) {
        auto p = parameters();
        FlatParameters flat(p);
        const AdamSettings settings{0.01, beta1, 0.99, 1e-8, decay};
        Adam adam(flat, settings);
        std::vector<double> value, mean(26, 0.0), square(26, 0.0);
        for (const auto& t : p)
            for (std::int64_t i = 0; i < t.numel(); ++i) value.push_back(t.flatten()[i].item<double>());
        for (int step = 1; step <= 5; ++step) {
            flat.zero_gradients();
            backward(p);
            std::vector<double> gradient;
            for (const auto& t : p)
                for (std::int64_t i = 0; i < t.numel(); ++i)
                    gradient.push_back(t.grad().flatten()[i].item<double>());
            const double share = step < 4 ? 1 : 0.25;
            adam.step(share);
            std::size_t at = 0;
            for (const auto& t : p)
                for (std::int64_t i = 0; i < t.numel(); ++i, ++at) {
                    mean[at] = beta1 * mean[at] + (1 - beta1) * gradient[at];
                    square[at] = 0.99 * square[at] + 0.01 * gradient[at] * gradient[at];
                    const double m = mean[at] / (1 - std::pow(beta1, step)),
                                 v = square[at] / (1 - std::pow(0.99, step));
                    value[at] *= 1 - share * 0.01 * decay;
                    value[at] -= share * 0.01 * m / (std::sqrt(v) + 1e-8);
                    // float32 against double over a few steps of about 0.01
                    EXPECT_NEAR(t.detach().flatten()[i].item<double>(), value[at], 2e-6)
                        << step << ", " << at;
                }
        }
    }
}
