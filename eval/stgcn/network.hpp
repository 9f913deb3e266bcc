// The ST-GCN described without tensors: its layers, and its tensors under the names of the public state_dict. Training (libtorch) and inference
// (OpenCL) both build the network from this. Source: Yan et al., "Spatial Temporal Graph Convolutional Networks for
// Skeleton-Based Action Recognition" (AAAI 2018), and its public code.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "eval/stgcn/graph.hpp"

namespace actformer::eval {

constexpr std::size_t stgcn_layers = 10;
constexpr std::size_t stgcn_taps = 9;  ///< frames of every temporal convolution

/// Of every layer: the stride over frames, and the public network's output channels.
constexpr std::array<std::uint32_t, stgcn_layers> stgcn_strides{1, 1, 1, 1, 2, 1, 1, 2, 1, 1};
constexpr std::array<std::uint32_t, stgcn_layers> stgcn_channels{64,  64,  64,  64,  128,
                                                                 128, 128, 256, 256, 256};

/// All that decides the shapes of a network.
struct StgcnShape {
    std::uint32_t channels = 0;  ///< of the input: numbers a joint, those of all persons together
    std::uint32_t classes = 0;
    Graph graph;
    std::array<std::uint32_t, stgcn_layers> widths{};  ///< output channels of every layer

    std::uint32_t joints() const { return graph.joints(); }
    std::uint32_t features() const { return widths.back(); }
};

/// Graph convolution, temporal convolution and residual.
struct StgcnLayer {
    enum class Residual { none, identity, convolution };
    std::uint32_t in = 0, out = 0, stride = 1;
    Residual residual = Residual::identity;
};

/// Layer 0 has no residual; the others' is a 1x1 convolution where channels or frames change.
StgcnLayer stgcn_layer(const StgcnShape& shape, std::size_t layer);

/// "st_gcn_networks.3."
std::string layer_prefix(std::size_t layer);

/// What a tensor is to its layer.
enum class TensorRole {
    weight,            ///< of a convolution
    bias,              ///< of a convolution
    gain,              ///< of a batch norm
    offset,            ///< of a batch norm
    running_mean,      ///< of a batch norm; not trained
    running_variance,  ///< of a batch norm; not trained
    importance         ///< of the graph's edges
};

struct StgcnTensor {
    std::string name;
    std::vector<std::uint64_t> shape;
    TensorRole role = TensorRole::weight;
    std::uint64_t fan_in = 0;  ///< of a convolution: inputs to one output

    std::uint64_t count() const;
};

/// Every tensor, in the order of the public state_dict's layers.
std::vector<StgcnTensor> stgcn_tensors(const StgcnShape& shape);

}  // namespace actformer::eval
