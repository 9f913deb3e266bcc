#include "model/nn/weight_store.hpp"

#include <ATen/core/grad_mode.h>
#include <gtest/gtest.h>

#include "model/nn/autocast.hpp"

namespace actformer::model {
namespace {

TEST(NoAutocast, KeepsTypesAsFarAsItsScopeReaches) {
    const bool was = c10::impl::tls_is_dispatch_key_excluded(c10::DispatchKey::AutocastCPU);
    c10::impl::tls_set_dispatch_key_excluded(c10::DispatchKey::AutocastCPU, false);
    const auto x = at::randn({4, 4});
    const auto type = [&] { return at::mm(x, x).scalar_type(); };
    EXPECT_EQ(type(), at::kBFloat16);
    {
        const NoAutocast kept;
        EXPECT_EQ(type(), at::kFloat);
    }
    EXPECT_EQ(type(), at::kBFloat16);
    c10::impl::tls_set_dispatch_key_excluded(c10::DispatchKey::AutocastCPU, was);
}

TEST(WeightStore, SpectralNormsStayInFloat32UnderAutocast) {
    if (!at::hasCUDA()) GTEST_SKIP() << "needs CUDA";
    torch::nn::Module module;
    const WeightStore weights(module, {{"layer.weight", {64, 48}, Init::normal, 1, true, 64}}, 1, at::kFloat);
    module.to(at::kCUDA);
    const at::NoGradGuard no_gradients;
    const auto plain = weights.normalised("layer.weight", false);
    const Autocast reduced(true);
    EXPECT_TRUE(weights.normalised("layer.weight", false).equal(plain));
}

}  // namespace
}  // namespace actformer::model
