#include "model/recognisers/stgcn.hpp"

#include <cmath>

#include "base/error.hpp"

namespace actformer::model {
namespace {

using eval::TensorRole;

std::uint32_t scaled(std::uint32_t channels, double width) {
    return 16 * static_cast<std::uint32_t>(std::max(1L, std::lround(channels * width / 16)));
}

Init init_of(TensorRole role) {
    switch (role) {
        case TensorRole::weight:
        case TensorRole::bias:
            return Init::uniform;
        case TensorRole::offset:
        case TensorRole::running_mean:
            return Init::zeros;
        default:
            return Init::ones;
    }
}

/// Weights and biases of convolutions start uniform within one over the root of the inputs to an output.
NetworkWeight weight_of(const eval::StgcnTensor& tensor) {
    NetworkWeight weight{tensor.name, {tensor.shape.begin(), tensor.shape.end()}, init_of(tensor.role)};
    if (weight.init == Init::uniform) weight.scale = 1 / std::sqrt(static_cast<double>(tensor.fan_in));
    weight.trained = tensor.role != TensorRole::running_mean && tensor.role != TensorRole::running_variance;
    return weight;
}

}  // namespace

eval::StgcnShape shape_of(const StgcnSettings& settings) {
    eval::StgcnShape shape{settings.channels, settings.classes, settings.graph, {}};
    for (std::size_t i = 0; i < eval::stgcn_layers; ++i)
        shape.widths[i] = scaled(eval::stgcn_channels[i], settings.width);
    return shape;
}

std::vector<NetworkWeight> stgcn_weights(const StgcnSettings& settings) {
    std::vector<NetworkWeight> weights;
    for (const auto& tensor : eval::stgcn_tensors(shape_of(settings))) weights.push_back(weight_of(tensor));
    return weights;
}

std::vector<SummaryLine> stgcn_summary(const StgcnSettings& settings, std::uint32_t frames) {
    const auto weights = stgcn_weights(settings);
    const std::int64_t joints = settings.graph.joints();
    std::int64_t t = frames;
    std::vector<SummaryLine> lines;
    lines.push_back({"data_bn",
                     "normalisation of the input",
                     {settings.channels, t, joints},
                     trained_count(weights, "data_bn.")});
    const auto shape = shape_of(settings);
    for (std::size_t i = 0; i < eval::stgcn_layers; ++i) {
        const auto layer = eval::stgcn_layer(shape, i);
        const auto prefix = eval::layer_prefix(i);
        const auto add = [&](const std::string& name, const std::string& kind, std::int64_t parameters) {
            lines.push_back({name, kind, {layer.out, t, joints}, parameters});
        };
        add(prefix + "gcn", "graph convolution, 3 parts",
            trained_count(weights, prefix + "gcn.") +
                trained_count(weights, fmt::format("edge_importance.{}", i)));
        t = (t + layer.stride - 1) / layer.stride;
        add(prefix + "tcn", layer.stride == 1 ? "9 frames" : fmt::format("9 frames, stride {}", layer.stride),
            trained_count(weights, prefix + "tcn."));
        if (layer.residual == eval::StgcnLayer::Residual::convolution)
            add(prefix + "residual", "shortcut, 1x1", trained_count(weights, prefix + "residual."));
    }
    lines.push_back({"mean", "over frames and joints: the features", {shape.features()}, 0});
    lines.push_back({"fcn", "logits", {settings.classes}, trained_count(weights, "fcn.")});
    return lines;
}

void check(const StgcnSettings& settings) {
    if (settings.channels == 0 || settings.graph.joints() == 0)
        throw Error("a recogniser needs joints with channels");
    if (settings.classes < 2) throw Error("a recogniser needs at least 2 classes, not {}", settings.classes);
    if (settings.graph.center >= settings.graph.joints())
        throw Error("the graph's centre is none of its joints");
    if (!(settings.width > 0) || !(settings.dropout >= 0 && settings.dropout < 1))
        throw Error("width {} or dropout {} is out of range", settings.width, settings.dropout);
}

}  // namespace actformer::model
