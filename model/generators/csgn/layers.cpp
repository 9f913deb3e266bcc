#include "model/generators/csgn/layers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace actformer::model {
namespace {

/// Deviation that the generator's weights start with.
constexpr double start_deviation = 0.02;

HopMatrix matrix_of(const CsgnSettings& s, const NodeGraph& graph, const std::vector<std::uint32_t>& kept) {
    return s.partition == Partition::radial ? radial_hop_matrix(graph, kept) : hop_matrix(graph, kept);
}

HopMatrix within(const CsgnSettings& s, const NodeGraph& graph) {
    return matrix_of(s, graph, all_nodes(graph));
}

/// From one node to every node of the coarsest level, each with a weight of its own: as if by a hop of its own.
HopMatrix unfolding(std::uint32_t nodes) {
    HopMatrix matrix{nodes, nodes, 1, std::vector<float>(std::size_t{nodes} * nodes, 0)};
    for (std::uint32_t i = 0; i < nodes; ++i) matrix.values[std::size_t{i} * nodes + i] = 1;
    return matrix;
}

GraphConvolution doubling(const std::string& name, std::uint32_t in, std::uint32_t out, HopMatrix sums) {
    return {name, in, 2 * out, 2, 1, 1, std::move(sums)};
}

GraphConvolution halving(const std::string& name, std::uint32_t in, std::uint32_t out, HopMatrix sums) {
    return {name, in, out, 4, 2, 1, std::move(sums)};
}

std::vector<std::int64_t> weight_shape(const GraphConvolution& layer) {
    return {layer.out, layer.sums.hops, layer.taps, layer.in};
}

/// Of the uniform numbers that PyTorch's layers start with.
double bound_of(std::int64_t inputs) {
    return 1 / std::sqrt(static_cast<double>(inputs));
}

std::string between(const GraphConvolution& layer, const char* frames) {
    return fmt::format("graph convolution {} to {} nodes, {}", layer.sums.inputs, layer.sums.outputs, frames);
}

}  // namespace

cpu::NodeShape GraphConvolution::shape(std::int64_t samples, std::int64_t frames,
                                       std::int64_t out_padding) const {
    return cpu::NodeShape{.samples = samples,
                          .frames = frames,
                          .in_nodes = sums.inputs,
                          .out_nodes = sums.outputs,
                          .in = in,
                          .out = out,
                          .taps = taps,
                          .stride = stride,
                          .padding = padding,
                          .out_padding = out_padding};
}

GeneratorLayers generator_layers(const CsgnSettings& s) {
    const auto graphs = skeleton_levels(s.parents, Mirror::first);
    const auto b = s.width;
    GeneratorLayers layers;
    layers.levels.push_back(doubling("up0", s.latent, 8 * b, unfolding(graphs.coarse.nodes())));
    layers.levels.push_back(doubling("up1", 8 * b, 4 * b, transposed(within(s, graphs.coarse))));
    layers.levels.push_back(
        doubling("up2", 4 * b, 2 * b, transposed(matrix_of(s, graphs.middle, graphs.coarse_kept))));
    layers.levels.push_back(
        doubling("up3", 2 * b, b, transposed(matrix_of(s, graphs.fine, graphs.middle_kept))));
    layers.last = {"out", b, s.channels(), 5, 1, 2, within(s, graphs.fine)};
    return layers;
}

DiscriminatorLayers discriminator_layers(const CsgnSettings& s) {
    const auto graphs = skeleton_levels(s.parents, Mirror::first);
    const auto b = s.d_width;
    DiscriminatorLayers layers;
    layers.levels.push_back({"conv0", 2 * s.channels(), b, 5, 1, 2, within(s, graphs.fine)});
    layers.levels.push_back(halving("down1", b, 2 * b, matrix_of(s, graphs.fine, graphs.middle_kept)));
    layers.levels.push_back(halving("down2", 2 * b, 4 * b, matrix_of(s, graphs.middle, graphs.coarse_kept)));
    layers.levels.push_back(halving("down3", 4 * b, 8 * b, within(s, graphs.coarse)));
    const auto nodes = graphs.coarse.nodes();
    layers.last = halving("conv4", 8 * b, s.features(), {1, 1, nodes, std::vector<float>(nodes, 1)});
    return layers;
}

std::vector<NetworkWeight> csgn_generator_weights(const CsgnSettings& s) {
    std::vector<NetworkWeight> list;
    const auto layers = generator_layers(s);
    for (std::size_t i = 0; i < layers.levels.size(); ++i) {
        const auto& level = layers.levels[i];
        const auto norm = fmt::format("norm{}.", i);
        const std::int64_t classes = s.classes, width = level.out / 2;
        list.push_back({level.name + ".weight", weight_shape(level), Init::normal, start_deviation});
        list.push_back({norm + "gain", {classes, width}, Init::ones});
        list.push_back({norm + "shift", {classes, width}, Init::zeros});
        list.push_back({norm + "mean", {width}, Init::zeros, 0, false, 0, false});
        list.push_back({norm + "variance", {width}, Init::ones, 0, false, 0, false});
    }
    const auto& last = layers.last;
    list.push_back({last.name + ".weight", weight_shape(last), Init::normal, start_deviation});
    list.push_back({last.name + ".bias", {last.sums.hops, last.out}, Init::zeros});
    return list;
}

std::vector<NetworkWeight> csgn_discriminator_weights(const CsgnSettings& s) {
    std::vector<NetworkWeight> list;
    const auto layers = discriminator_layers(s);
    for (const auto& level : layers.levels) {
        const double bound = bound_of(std::int64_t{level.in} * level.taps);
        list.push_back({level.name + ".weight", weight_shape(level), Init::uniform, bound, true, level.out});
        if (&level == &layers.levels.front())
            list.push_back({level.name + ".bias", {level.sums.hops, level.out}, Init::uniform, bound});
    }
    const auto& last = layers.last;
    const std::int64_t features = last.out;
    const double bound = bound_of(std::int64_t{last.in} * last.taps * last.sums.inputs);
    list.push_back({last.name + ".weight",
                    {features, last.sums.inputs, last.taps, last.in},
                    Init::uniform,
                    bound,
                    true,
                    features});
    list.push_back({last.name + ".bias", {features}, Init::uniform, bound});
    list.push_back({"score.weight", {1, features}, Init::uniform, bound_of(features), true, 1});
    list.push_back({"score.bias", {1}, Init::uniform, bound_of(features)});
    list.push_back({"classes.weight", {s.classes, features}, Init::normal, 1, true, s.classes});
    return list;
}

std::vector<SummaryLine> csgn_generator_summary(const CsgnSettings& s) {
    const auto weights = csgn_generator_weights(s);
    const auto layers = generator_layers(s);
    std::int64_t t = latent_frames(s.frames);
    std::vector<SummaryLine> lines;
    lines.push_back({"prior", "Gaussian processes", {s.latent, t, 1}, 0});
    for (std::size_t i = 0; i < layers.levels.size(); ++i) {
        const auto& level = layers.levels[i];
        t *= 2;
        const std::vector<std::int64_t> shape{level.out / 2, t, level.sums.outputs};
        const auto norm = fmt::format("norm{}", i);
        lines.push_back({level.name, between(level, "twice the frames"), shape,
                         trained_count(weights, level.name + ".")});
        lines.push_back(
            {norm, "batch norm, gain and shift of the class", shape, trained_count(weights, norm + ".")});
    }
    const auto& last = layers.last;
    lines.push_back({last.name,
                     between(last, "5 frames"),
                     {s.channels(), s.frames, s.nodes()},
                     trained_count(weights, last.name + ".")});
    return lines;
}

std::vector<SummaryLine> csgn_discriminator_summary(const CsgnSettings& s) {
    const auto weights = csgn_discriminator_weights(s);
    const auto layers = discriminator_layers(s);
    std::int64_t t = s.frames;
    std::vector<SummaryLine> lines;
    lines.push_back({"input", "with differences over time", {2 * s.channels(), t, s.nodes()}, 0});
    for (const auto& level : layers.levels) {
        t = level.shape(1, t, 0).out_frames();
        lines.push_back({level.name,
                         between(level, fmt::format("{} frames", level.taps).c_str()),
                         {level.out, t, level.sums.outputs},
                         trained_count(weights, level.name + ".")});
    }
    t = layers.last.shape(1, t, 0).out_frames();
    lines.push_back({layers.last.name,
                     "convolution over nodes and 4 frames",
                     {s.features(), t, 1},
                     trained_count(weights, layers.last.name + ".")});
    lines.push_back({"score", "of the features' sums", {1}, trained_count(weights, "score.")});
    lines.push_back({"classes", "embedding times features", {1}, trained_count(weights, "classes.")});
    return lines;
}

}  // namespace actformer::model
