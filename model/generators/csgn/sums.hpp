// Fixed sums of a graph convolution as a network holds them. Includes torch headers.
#pragma once

#include <torch/nn/module.h>

#include "model/generators/csgn/layers.hpp"
#include "model/generators/graph/node_convolution.hpp"

namespace actformer::model {

/// Registers the matrix as the buffer NAME_sums, so that to(device) moves it.
inline GraphSums registered_sums(torch::nn::Module& network, const GraphConvolution& layer,
                                 at::ScalarType type) {
    const auto& sums = layer.sums;
    auto values = sums.values;
    const auto matrix = at::from_blob(values.data(), {sums.hops, sums.outputs, sums.inputs}, at::kFloat);
    return {network.register_buffer(layer.name + "_sums", matrix.to(type, false, true)),
            std::make_shared<cpu::NodeSums>(sums.hops, sums.outputs, sums.inputs, sums.values)};
}

}  // namespace actformer::model
