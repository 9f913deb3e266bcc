#include "model/train/torch_device.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

using namespace actformer;

// libtorch lets cuDNN round to TF32 unless it is told not to.
TEST(Tf32AndDeterminism, Float32IsFloat32UnlessAskedOtherwise) {
    auto& context = at::globalContext();
    context.setAllowTF32CuDNN(true);
    context.setAllowTF32CuBLAS(true);
    model::set_tf32_and_determinism({}, at::kCPU);
    EXPECT_FALSE(context.allowTF32CuDNN());
    EXPECT_FALSE(context.allowTF32CuBLAS());
    model::TrainerSettings settings;
    settings.tf32 = true;
    EXPECT_THROW(model::set_tf32_and_determinism(settings, at::kCPU), Error);
}
