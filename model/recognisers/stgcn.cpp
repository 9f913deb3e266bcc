#include "model/recognisers/stgcn.hpp"

#include <cmath>
#include <functional>
#include <numeric>

#include "base/error.hpp"

namespace actformer::model {
namespace {

using eval::TensorRole;

std::uint32_t scaled(std::uint32_t channels, double width) {
    return 16 * static_cast<std::uint32_t>(std::max(1L, std::lround(channels * width / 16)));
}

Start start_of(TensorRole role) {
    switch (role) {
        case TensorRole::weight:
        case TensorRole::bias:
            return Start::uniform;
        case TensorRole::offset:
        case TensorRole::running_mean:
            return Start::zeros;
        default:
            return Start::ones;
    }
}

/// Weights and biases of convolutions start uniform within one over the root of the inputs to an output.
WeightInfo info_of(const eval::StgcnTensor& tensor) {
    WeightInfo info{tensor.name, {tensor.shape.begin(), tensor.shape.end()}, start_of(tensor.role)};
    if (info.start == Start::uniform) info.bound = 1 / std::sqrt(static_cast<double>(tensor.fan_in));
    info.trained = tensor.role != TensorRole::running_mean && tensor.role != TensorRole::running_variance;
    return info;
}

std::int64_t trained_under(const std::vector<WeightInfo>& weights, const std::string& prefix) {
    std::int64_t sum = 0;
    for (const auto& weight : weights)
        if (weight.trained && weight.name.starts_with(prefix)) sum += weight.count();
    return sum;
}

}  // namespace

std::int64_t WeightInfo::count() const {
    return std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>());
}

eval::StgcnShape shape_of(const StgcnSettings& settings) {
    eval::StgcnShape shape{settings.channels, settings.classes, settings.graph, {}};
    for (std::size_t i = 0; i < eval::stgcn_layers; ++i)
        shape.widths[i] = scaled(eval::stgcn_channels[i], settings.width);
    return shape;
}

std::vector<WeightInfo> stgcn_weights(const StgcnSettings& settings) {
    std::vector<WeightInfo> infos;
    for (const auto& tensor : eval::stgcn_tensors(shape_of(settings))) infos.push_back(info_of(tensor));
    return infos;
}

std::vector<SummaryLine> stgcn_summary(const StgcnSettings& settings, std::uint32_t frames) {
    const auto weights = stgcn_weights(settings);
    const std::int64_t joints = settings.graph.joints();
    std::int64_t t = frames;
    std::vector<SummaryLine> lines;
    lines.push_back({"data_bn",
                     "normalisation of the input",
                     {settings.channels, t, joints},
                     trained_under(weights, "data_bn.")});
    const auto shape = shape_of(settings);
    for (std::size_t i = 0; i < eval::stgcn_layers; ++i) {
        const auto layer = eval::stgcn_layer(shape, i);
        const auto prefix = eval::layer_prefix(i);
        const auto add = [&](const std::string& name, const std::string& kind, std::int64_t parameters) {
            lines.push_back({name, kind, {layer.out, t, joints}, parameters});
        };
        add(prefix + "gcn", "graph convolution, 3 parts",
            trained_under(weights, prefix + "gcn.") +
                trained_under(weights, fmt::format("edge_importance.{}", i)));
        t = (t + layer.stride - 1) / layer.stride;
        add(prefix + "tcn", layer.stride == 1 ? "9 frames" : fmt::format("9 frames, stride {}", layer.stride),
            trained_under(weights, prefix + "tcn."));
        if (layer.residual == eval::StgcnLayer::Residual::convolution)
            add(prefix + "residual", "shortcut, 1x1", trained_under(weights, prefix + "residual."));
    }
    lines.push_back({"mean", "over frames and joints: the features", {shape.features()}, 0});
    lines.push_back({"fcn", "logits", {settings.classes}, trained_under(weights, "fcn.")});
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
