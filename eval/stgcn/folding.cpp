#include "eval/stgcn/folding.hpp"

#include <fmt/format.h>

#include <cmath>

namespace actformer::eval {
namespace {

/// A batch norm at inference: x * scale + shift.
struct Affine {
    std::vector<double> scale, shift;
};

Affine norm(const StgcnWeights& weights, const std::string& prefix) {
    constexpr double epsilon = 1e-5;
    const auto &gain = weights.at(prefix + "weight"), &offset = weights.at(prefix + "bias");
    const auto &mean = weights.at(prefix + "running_mean"), &variance = weights.at(prefix + "running_var");
    Affine out;
    for (std::size_t c = 0; c < gain.size(); ++c) {
        out.scale.push_back(gain[c] / std::sqrt(variance[c] + epsilon));
        out.shift.push_back(offset[c] - mean[c] * out.scale[c]);
    }
    return out;
}

void fold_graph(const StgcnWeights& weights, std::size_t index, FoldedLayer& layer) {
    const auto prefix = layer_prefix(index);
    const auto affine = norm(weights, prefix + "tcn.0.");
    const auto &weight = weights.at(prefix + "gcn.conv.weight"), &bias = weights.at(prefix + "gcn.conv.bias");
    const auto& importance = weights.at(fmt::format("edge_importance.{}", index));
    const std::size_t in = layer.in, out = layer.out, joints = weights.joints(), square = joints * joints;

    layer.mixing = partition(weights.graph);
    for (std::size_t part = 0; part < 3; ++part)
        for (std::size_t i = 0; i < square; ++i) layer.mixing[part][i] *= importance[part * square + i];

    layer.graph_weight.resize(3 * in * out);
    for (std::size_t part = 0; part < 3; ++part)
        for (std::size_t o = 0; o < out; ++o)
            for (std::size_t i = 0; i < in; ++i)
                layer.graph_weight[(part * in + i) * out + o] =
                    weight[(part * out + o) * in + i] * affine.scale[o];

    layer.graph_bias.resize(joints * out);
    for (std::size_t w = 0; w < joints; ++w)
        for (std::size_t o = 0; o < out; ++o) {
            double sum = 0;
            for (std::size_t part = 0; part < 3; ++part)
                for (std::size_t v = 0; v < joints; ++v)
                    sum += layer.mixing[part][v * joints + w] * bias[part * out + o];
            layer.graph_bias[w * out + o] = sum * affine.scale[o] + affine.shift[o];
        }
}

void fold_temporal(const StgcnWeights& weights, std::size_t index, FoldedLayer& layer) {
    const auto prefix = layer_prefix(index);
    const auto affine = norm(weights, prefix + "tcn.3.");
    const auto &weight = weights.at(prefix + "tcn.2.weight"), &bias = weights.at(prefix + "tcn.2.bias");
    const std::size_t out = layer.out;
    layer.temporal_weight.resize(out * out * stgcn_taps);
    for (std::size_t o = 0; o < out; ++o) {
        layer.temporal_bias.push_back(bias[o] * affine.scale[o] + affine.shift[o]);
        for (std::size_t i = 0; i < out; ++i)
            for (std::size_t t = 0; t < stgcn_taps; ++t)
                layer.temporal_weight[(i * out + o) * stgcn_taps + t] =
                    weight[(o * out + i) * stgcn_taps + t] * affine.scale[o];
    }
}

void fold_residual(const StgcnWeights& weights, std::size_t index, FoldedLayer& layer) {
    const auto residual = stgcn_layer(weights, index).residual;
    layer.identity_residual = residual == StgcnLayer::Residual::identity;
    if (residual != StgcnLayer::Residual::convolution) return;
    const auto prefix = layer_prefix(index);
    const auto affine = norm(weights, prefix + "residual.1.");
    const auto &weight = weights.at(prefix + "residual.0.weight"),
               &bias = weights.at(prefix + "residual.0.bias");
    layer.residual_weight.resize(std::size_t{layer.in} * layer.out);
    for (std::size_t o = 0; o < layer.out; ++o) {
        layer.temporal_bias[o] += bias[o] * affine.scale[o] + affine.shift[o];
        for (std::size_t i = 0; i < layer.in; ++i)
            layer.residual_weight[i * layer.out + o] = weight[o * layer.in + i] * affine.scale[o];
    }
}

}  // namespace

FoldedNetwork fold(const StgcnWeights& weights) {
    FoldedNetwork network;
    auto input = norm(weights, "data_bn.");
    network.scale = std::move(input.scale);
    network.shift = std::move(input.shift);
    for (std::size_t i = 0; i < stgcn_layers; ++i) {
        const auto shape = stgcn_layer(weights, i);
        FoldedLayer layer;
        layer.in = shape.in;
        layer.out = shape.out;
        layer.stride = shape.stride;
        fold_graph(weights, i, layer);
        fold_temporal(weights, i, layer);
        fold_residual(weights, i, layer);
        network.layers.push_back(std::move(layer));
    }
    return network;
}

}  // namespace actformer::eval
