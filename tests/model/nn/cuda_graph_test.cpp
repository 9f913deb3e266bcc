#include "model/nn/cuda_graph.hpp"

#include <ATen/ATen.h>
#include <gtest/gtest.h>

namespace actformer::model {
namespace {

TEST(CudaGraph, OnProcessorsTheWorkIsDoneEveryTime) {
    CudaGraph graph(at::kCPU, true);
    int calls = 0;
    for (int i = 0; i < CudaGraph::warmup_calls + 5; ++i) graph.run([&] { ++calls; });
    EXPECT_EQ(calls, CudaGraph::warmup_calls + 5);
}

TEST(CudaGraph, ReplaysReadWhatIsThereThen) {
    if (!at::hasCUDA()) GTEST_SKIP() << "needs CUDA";
    const auto x = at::zeros({5}, at::TensorOptions(at::kCUDA)), y = at::empty_like(x);
    for (const bool wanted : {true, false}) {
        CudaGraph graph(at::kCUDA, wanted);
        int calls = 0;
        for (int i = 0; i < 9; ++i) {
            x.fill_(i);
            graph.run([&] {
                y.copy_(x * 2 + 1);
                ++calls;
            });
            EXPECT_EQ(y.sum().item<float>(), static_cast<float>(5 * (2 * i + 1))) << i;
        }
        EXPECT_EQ(calls, wanted ? CudaGraph::warmup_calls + 1 : 9);
    }
}

TEST(CudaGraph, WhatCannotBeCapturedIsSaidWithTheRemedy) {
    if (!at::hasCUDA()) GTEST_SKIP() << "needs CUDA";
    CudaGraph graph(at::kCUDA, true);
    const auto x = at::ones({1}, at::TensorOptions(at::kCUDA));
    try {
        for (int i = 0; i <= CudaGraph::warmup_calls; ++i) graph.run([&] { x.item<float>(); });
        FAIL() << "a wait for the device was captured";
    } catch (const std::exception& e) {
        EXPECT_NE(std::string(e.what()).find("cuda_graphs=false"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace actformer::model
