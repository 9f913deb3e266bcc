#include "model/recognisers/stgcn.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/error.hpp"

namespace actformer::model {
namespace {

struct PublicLayer {
    std::uint32_t out, stride;
};
constexpr std::array<PublicLayer, 10> public_layers{
    {{64, 1}, {64, 1}, {64, 1}, {64, 1}, {128, 2}, {128, 1}, {128, 1}, {256, 2}, {256, 1}, {256, 1}}};

std::uint32_t scaled(std::uint32_t channels, double width) {
    return 16 * static_cast<std::uint32_t>(std::max(1L, std::lround(channels * width / 16)));
}

/// Collects weights under their public names.
class WeightList {
  public:
    void norm(const std::string& name, std::int64_t channels) {
        add(name + ".weight", {channels}, Start::ones);
        add(name + ".bias", {channels}, Start::zeros);
        add(name + ".running_mean", {channels}, Start::zeros, 0, false);
        add(name + ".running_var", {channels}, Start::ones, 0, false);
    }
    /// Weights and biases start uniform within one over the root of the inputs to an output.
    void convolution(const std::string& name, std::int64_t out, std::int64_t in, std::int64_t taps) {
        const double reach = 1 / std::sqrt(static_cast<double>(in * taps));
        add(name + ".weight", {out, in, taps, 1}, Start::uniform, reach);
        add(name + ".bias", {out}, Start::uniform, reach);
    }
    void add(std::string name, std::vector<std::int64_t> shape, Start start, double reach = 0,
             bool trained = true) {
        list_.push_back({std::move(name), std::move(shape), start, reach, trained});
    }
    std::vector<WeightInfo> take() { return std::move(list_); }

  private:
    std::vector<WeightInfo> list_;
};

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

std::vector<StgcnLayer> stgcn_layers(const StgcnSettings& settings) {
    std::vector<StgcnLayer> layers;
    auto in = settings.channels;
    for (const auto& layer : public_layers) {
        const auto out = scaled(layer.out, settings.width);
        const auto shortcut = layers.empty()                   ? StgcnLayer::Shortcut::none
                              : in == out && layer.stride == 1 ? StgcnLayer::Shortcut::identity
                                                               : StgcnLayer::Shortcut::convolution;
        layers.push_back({in, out, layer.stride, shortcut});
        in = out;
    }
    return layers;
}

std::vector<WeightInfo> stgcn_weights(const StgcnSettings& settings) {
    const std::int64_t joints = settings.graph.joints();
    WeightList list;
    list.norm("data_bn", settings.channels * joints);
    const auto layers = stgcn_layers(settings);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const auto& layer = layers[i];
        const auto prefix = fmt::format("st_gcn_networks.{}.", i);
        list.convolution(prefix + "gcn.conv", 3 * std::int64_t{layer.out}, layer.in, 1);
        list.norm(prefix + "tcn.0", layer.out);
        list.convolution(prefix + "tcn.2", layer.out, layer.out, temporal_taps);
        list.norm(prefix + "tcn.3", layer.out);
        if (layer.shortcut == StgcnLayer::Shortcut::convolution) {
            list.convolution(prefix + "residual.0", layer.out, layer.in, 1);
            list.norm(prefix + "residual.1", layer.out);
        }
        list.add(fmt::format("edge_importance.{}", i), {3, joints, joints}, Start::ones);
    }
    list.convolution("fcn", settings.classes, layers.back().out, 1);
    return list.take();
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
    const auto layers = stgcn_layers(settings);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const auto& layer = layers[i];
        const auto prefix = fmt::format("st_gcn_networks.{}.", i);
        const auto add = [&](const std::string& name, const std::string& kind, std::int64_t parameters) {
            lines.push_back({name, kind, {layer.out, t, joints}, parameters});
        };
        add(prefix + "gcn", "graph convolution, 3 parts",
            trained_under(weights, prefix + "gcn.") +
                trained_under(weights, fmt::format("edge_importance.{}", i)));
        t = (t + layer.stride - 1) / layer.stride;
        add(prefix + "tcn", layer.stride == 1 ? "9 frames" : fmt::format("9 frames, stride {}", layer.stride),
            trained_under(weights, prefix + "tcn."));
        if (layer.shortcut == StgcnLayer::Shortcut::convolution)
            add(prefix + "residual", "shortcut, 1x1", trained_under(weights, prefix + "residual."));
    }
    lines.push_back({"mean", "over frames and joints: the features", {layers.back().out}, 0});
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
