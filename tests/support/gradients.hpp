// Gradients against finite differences.
#pragma once

#include <ATen/ATen.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace actformer::test {

/// Normal random numbers times `size`, in double, of which gradients are asked.
inline at::Tensor random_input(at::IntArrayRef shape, double size = 1) {
    return (at::randn(shape, at::kDouble) * size).set_requires_grad(true);
}

/// Gradients of sum(probe * function(inputs)) to a few numbers of every input, against central differences.
inline void expect_gradients(const std::function<at::Tensor(const std::vector<at::Tensor>&)>& function,
                             const std::vector<at::Tensor>& inputs) {
    const auto probe = at::randn_like(function(inputs).detach());
    const auto loss = [&] { return (function(inputs) * probe).sum(); };
    loss().backward();
    for (std::size_t which = 0; which < inputs.size(); ++which) {
        auto input = inputs[which];
        if (!input.requires_grad()) continue;
        ASSERT_TRUE(input.grad().defined()) << "input " << which;
        const auto grad = input.grad().contiguous();
        const at::NoGradGuard no_gradients;
        const auto step = std::max<std::int64_t>(1, input.numel() / 41);
        for (std::int64_t i = 0; i < input.numel(); i += step) {
            double& value = input.data_ptr<double>()[i];
            const double kept = value, h = 1e-5;
            value = kept + h;
            const double above = loss().item<double>();
            value = kept - h;
            const double below = loss().item<double>();
            value = kept;
            EXPECT_NEAR(grad.data_ptr<double>()[i], (above - below) / (2 * h), 2e-6 * (1 + std::abs(above)))
                << "input " << which << ", number " << i;
        }
    }
}

}  // namespace actformer::test
