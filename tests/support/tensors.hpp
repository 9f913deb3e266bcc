#pragma once

#include <ATen/ATen.h>
#include <gtest/gtest.h>

#include <string>

namespace actformer::test {

/// Within `tolerance` times 1 + the largest of `theirs`, compared in double.
inline void expect_near(const at::Tensor& ours, const at::Tensor& theirs, double tolerance,
                        const std::string& what = "") {
    ASSERT_EQ(ours.sizes(), theirs.sizes()) << what;
    const auto scale = 1 + theirs.abs().max().item<double>();
    EXPECT_LE((ours.to(at::kDouble) - theirs.to(at::kDouble)).abs().max().item<double>(), tolerance * scale)
        << what;
}

}  // namespace actformer::test
