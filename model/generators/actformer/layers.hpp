// ActFormer's networks described without tensors: their weights in order, their layers and parameter counts. Knows nothing of torch.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/generators/actformer/settings.hpp"
#include "model/generators/graph/coarsening.hpp"
#include "model/nn/network.hpp"

namespace actformer::model {

/// One graph convolution of the discriminator: every (hop, input node) has its own temporal convolution, summed into the
/// output nodes by `sums`. Its weight is (inputs, hops, out, taps, in).
struct NodeConvolution {
    std::uint32_t in = 0, out = 0, taps = 0, stride = 1, padding = 0;
    bool bias = false;
    HopMatrix sums;

    std::uint32_t frames_out(std::uint32_t frames) const {
        return (frames + 2 * padding - taps) / stride + 1;
    }
};

/// Those before the last, full convolution.
std::vector<NodeConvolution> node_convolutions(const ActFormerDiscriminatorSettings& settings);

/// The last convolution takes all nodes and 4 frames at a stride of 2, padded by 1: a weight (features, nodes, taps, in).
constexpr std::uint32_t last_taps = 4;

/// Channels of a graphconv body on the coarse, middle and fine graph.
struct GraphBody {
    std::uint32_t coarse = 128, middle = 64, fine = 32;
};

std::vector<NetworkWeight> actformer_generator_weights(const ActFormerGeneratorSettings& settings);
std::vector<NetworkWeight> actformer_discriminator_weights(const ActFormerDiscriminatorSettings& settings);

/// Transformer blocks in order: true for an I-Former, false for a T-Former.
std::vector<bool> interacting_blocks(const ActFormerGeneratorSettings& settings);

/// Lines for `actformer model`; shapes are of one motion of `frames` frames.
std::vector<SummaryLine> actformer_generator_summary(const ActFormerGeneratorSettings& settings,
                                                     std::uint32_t frames);
std::vector<SummaryLine> actformer_discriminator_summary(const ActFormerDiscriminatorSettings& settings,
                                                         std::uint32_t frames);

}  // namespace actformer::model
