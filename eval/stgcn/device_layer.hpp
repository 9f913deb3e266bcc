// The ST-GCN's folded layers as the kernels take them.
#pragma once

#include "eval/stgcn/folding.hpp"
#include "kernels/stgcn.hpp"

namespace actformer::eval {

std::vector<float> to_float(const std::vector<double>& values);

/// A layer on the device.
struct DeviceLayer {
    std::uint32_t in = 0, out = 0, stride = 1;
    kernels::Mixture mixture;  ///< joints to the panels that the graph convolution multiplies beside theirs
    kernels::Mixture stepped;  ///< joints as they are, for the residual's convolution at a stride
    kernels::Problems graph, temporal, residual;
    kernels::PackedWeights graph_weight, temporal_weight, residual_weight;
    kernels::Buffer<float> graph_bias, temporal_bias;
    bool identity_residual = false, residual_convolution = false;
};

/// Packs a layer's weights, and lists which panels its products read.
DeviceLayer place(const kernels::Stgcn& kernels, const FoldedLayer& from, std::uint32_t joints);

}  // namespace actformer::eval
