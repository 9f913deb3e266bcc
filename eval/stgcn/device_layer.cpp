#include "eval/stgcn/device_layer.hpp"

namespace actformer::eval {
namespace {

using kernels::Buffer;

/// Collects sources panel by panel.
struct MixtureBuilder {
    std::vector<std::uint32_t> first{0}, source;
    std::vector<float> share;

    void add(std::size_t joint, double of_it) {
        source.push_back(static_cast<std::uint32_t>(joint));
        share.push_back(static_cast<float>(of_it));
    }
    void close() { first.push_back(static_cast<std::uint32_t>(source.size())); }
    std::uint32_t panels() const { return static_cast<std::uint32_t>(first.size() - 1); }
    kernels::Mixture build(kernels::Device& device) const {
        return {Buffer<std::uint32_t>(device, first), Buffer<std::uint32_t>(device, source),
                Buffer<float>(device, share), panels()};
    }
};

struct ProblemBuilder {
    std::vector<std::uint32_t> first{0}, segments;
    std::vector<float> scales;

    void add(std::uint32_t panel, std::uint32_t set, double scale = 1) {
        segments.insert(segments.end(), {panel, set});
        scales.push_back(static_cast<float>(scale));
    }
    void close() { first.push_back(static_cast<std::uint32_t>(segments.size() / 2)); }
    kernels::Problems build(kernels::Device& device) const {
        return {Buffer<std::uint32_t>(device, first), Buffer<std::uint32_t>(device, segments),
                Buffer<float>(device, scales), static_cast<std::uint32_t>(first.size() - 1)};
    }
};

/// One problem for every joint. Its own part of the neighbourhood reads the joint's panel as it is and scales the product,
/// so that only the other two parts need panels of mixed joints, and those only where they are not empty.
void place_graph(const kernels::Stgcn& kernels, const FoldedLayer& from, std::uint32_t joints,
                 DeviceLayer& layer) {
    MixtureBuilder mixture;
    ProblemBuilder problems;
    for (std::uint32_t w = 0; w < joints; ++w) {
        problems.add(w, 0, from.mixing[0][w * joints + w]);
        for (std::uint32_t part = 1; part < 3; ++part) {
            bool any = false;
            for (std::uint32_t v = 0; v < joints; ++v)
                if (const double share = from.mixing[part][v * joints + w]; share != 0) {
                    mixture.add(v, share);
                    any = true;
                }
            if (!any) continue;
            problems.add(joints + mixture.panels(), part);
            mixture.close();
        }
        problems.close();
    }
    layer.mixture = mixture.build(kernels.device());
    layer.graph = problems.build(kernels.device());
    layer.graph_weight = kernels.pack(to_float(from.graph_weight), 3, from.in, from.out);

    const auto pitch = kernels.pitch(from.out);
    std::vector<float> bias(std::size_t{joints} * pitch, 0.0F);
    for (std::size_t w = 0; w < joints; ++w)
        for (std::size_t o = 0; o < from.out; ++o)
            bias[w * pitch + o] = static_cast<float>(from.graph_bias[w * from.out + o]);
    layer.graph_bias = Buffer<float>(kernels.device(), bias);
}

/// One problem for every point that comes out; where two phases meet in it, it has two segments.
void place_temporal(const kernels::Stgcn& kernels, const FoldedLayer& from, DeviceLayer& layer) {
    const auto points = kernels::filtering(from.stride);
    const std::size_t square = std::size_t{from.out} * from.out;
    std::vector<float> weight(points.points_in * square);
    for (std::size_t i = 0; i < square; ++i) {
        const auto values = kernels::filter_points(
            std::span<const double, stgcn_taps>(&from.temporal_weight[i * stgcn_taps], stgcn_taps),
            from.stride);
        for (std::size_t p = 0; p < values.size(); ++p)
            weight[p * square + i] = static_cast<float>(values[p]);
    }
    layer.temporal_weight = kernels.pack(weight, points.points_in, from.out, from.out);

    ProblemBuilder problems;
    for (std::uint32_t p = 0; p < points.points_out; ++p) {
        for (std::uint32_t panel = p; panel < points.points_in; panel += points.points_out)
            problems.add(panel, panel);
        problems.close();
    }
    layer.temporal = problems.build(kernels.device());

    auto bias = to_float(from.temporal_bias);
    bias.resize(kernels.pitch(from.out), 0.0F);
    layer.temporal_bias = Buffer<float>(kernels.device(), bias);
}

void place_residual(const kernels::Stgcn& kernels, const FoldedLayer& from, std::uint32_t joints,
                    DeviceLayer& layer) {
    layer.identity_residual = from.identity_residual;
    layer.residual_convolution = !from.residual_weight.empty();
    if (!layer.residual_convolution) return;
    MixtureBuilder mixture;
    ProblemBuilder problems;
    for (std::uint32_t k = 0; k < joints; ++k) {
        mixture.add(k, 1);
        mixture.close();
        problems.add(k, 0);
        problems.close();
    }
    layer.stepped = mixture.build(kernels.device());
    layer.residual = problems.build(kernels.device());
    layer.residual_weight = kernels.pack(to_float(from.residual_weight), 1, from.in, from.out);
}

}  // namespace

std::vector<float> to_float(const std::vector<double>& values) {
    return {values.begin(), values.end()};
}

DeviceLayer place(const kernels::Stgcn& kernels, const FoldedLayer& from, std::uint32_t joints) {
    DeviceLayer layer;
    layer.in = from.in;
    layer.out = from.out;
    layer.stride = from.stride;
    place_graph(kernels, from, joints, layer);
    place_temporal(kernels, from, layer);
    place_residual(kernels, from, joints, layer);
    return layer;
}

}  // namespace actformer::eval
