// CSGN's networks described without tensors: their weights in order, their layers and parameter counts. Knows nothing of torch.
#pragma once

#include <vector>

#include "model/cpu/node_kernels.hpp"
#include "model/generators/csgn/settings.hpp"
#include "model/generators/graph/coarsening.hpp"
#include "model/nn/network.hpp"

namespace actformer::model {

/// One graph convolution: every hop has a temporal convolution, the same for all nodes, summed into the output nodes by `sums`.
/// Its weight is (out, hops, taps, in).
struct GraphConvolution {
    std::string name;
    std::uint32_t in = 0, out = 0, taps = 0, stride = 1, padding = 0;
    HopMatrix sums;

    cpu::NodeShape shape(std::int64_t samples, std::int64_t frames, std::int64_t out_padding) const;
};

/// The generator's levels, coarse to fine, then its last layer. A level doubles the frames by a transposed convolution of kernel 4,
/// stride 2 and padding 1. Written as a plain one: over frames with a zero on either side, 2 taps give at every place the odd
/// frame before it and the even one behind it, side by side. So a level has twice its channels in `out`, odd frames' first, and
/// of its places the very first odd and the very last even frame are beyond the motion.
struct GeneratorLayers {
    std::vector<GraphConvolution> levels;
    GraphConvolution last;
};

GeneratorLayers generator_layers(const CsgnSettings& settings);

/// The discriminator's, fine to coarse; then its last one, over all nodes: a weight (features, nodes, taps, in).
struct DiscriminatorLayers {
    std::vector<GraphConvolution> levels;
    GraphConvolution last;
};

DiscriminatorLayers discriminator_layers(const CsgnSettings& settings);

std::vector<NetworkWeight> csgn_generator_weights(const CsgnSettings& settings);
std::vector<NetworkWeight> csgn_discriminator_weights(const CsgnSettings& settings);

/// Lines for `actformer model`; shapes are of one motion of settings.frames frames.
std::vector<SummaryLine> csgn_generator_summary(const CsgnSettings& settings);
std::vector<SummaryLine> csgn_discriminator_summary(const CsgnSettings& settings);

}  // namespace actformer::model
