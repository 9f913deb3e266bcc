#include "eval/stgcn/recogniser.hpp"

#include <algorithm>
#include <limits>

#include "eval/stgcn/folding.hpp"

namespace actformer::eval {
namespace {

using kernels::Buffer;
using kernels::Panels;

std::vector<float> to_float(const std::vector<double>& values) {
    return {values.begin(), values.end()};
}

/// A layer on the device.
struct DeviceLayer {
    std::uint32_t in = 0, out = 0, stride = 1;
    kernels::Mixture mixture;  ///< joints to the panels that the graph convolution multiplies beside theirs
    kernels::Mixture stepped;  ///< joints as they are, for the residual's convolution at a stride
    kernels::Problems graph, temporal, residual;
    kernels::PackedWeights graph_weight, temporal_weight, residual_weight;
    Buffer<float> graph_bias, temporal_bias;
    bool identity_residual = false, residual_convolution = false;
};

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

/// How many numbers a pass needs. Activations go from `x`, with panels of mixed joints behind the joints' own, through `y`
/// (graph) to `x_next` (temporal), each of `activation` numbers; `spread` holds points and `products` the points multiplied.
struct Sizes {
    std::size_t activation = 0, residual = 0, spread = 0, products = 0;

    bool hold(const Sizes& other) const {
        return activation >= other.activation && residual >= other.residual && spread >= other.spread &&
               products >= other.products;
    }
};

/// Memory for a pass, kept for the next. Padding must hold numbers, hence zeros; writing them also proves that the memory
/// is there.
struct Workspace {
    Sizes sizes;
    Buffer<float> x, x_next, y, residual, spread, products;

    Workspace() = default;
    Workspace(kernels::Device& device, const Sizes& room) : sizes(room) {
        for (auto* buffer : {&x, &x_next, &y}) *buffer = Buffer<float>(device, room.activation);
        residual = Buffer<float>(device, room.residual);
        spread = Buffer<float>(device, room.spread);
        products = Buffer<float>(device, room.products);
        try {
            for (auto* buffer : {&x, &x_next, &y, &residual, &spread, &products})
                if (buffer->size() > 0)
                    device.queue().enqueueFillBuffer(buffer->memory(), 0.0F, 0,
                                                     buffer->size() * sizeof(float));
            device.queue().finish();
        } catch (const cl::Error& e) {
            raise(device.info(), "making room for activations", e);
        }
    }
};

}  // namespace

struct Recogniser::Network {
    kernels::Device* device;
    kernels::Stgcn kernels;
    std::uint32_t channels, joints, classes;
    std::vector<DeviceLayer> layers;
    Buffer<float> scale, shift, class_weight, class_bias;
    Workspace space;
    std::size_t most_frames =
        std::numeric_limits<std::size_t>::max();  // sequences x frames that were found to fit
    std::function<void(std::size_t, Step)> probe;

    Network(kernels::Device& on, const Weights& weights, const kernels::Tiles& tiles);

    Panels view(const Buffer<float>& memory, std::uint32_t count, std::size_t rows,
                std::uint32_t width) const {
        const Panels panels{memory.memory(), count, kernels.rows(rows), kernels.pitch(width)};
        if (std::size_t{count} * panels.rows * panels.pitch > memory.size())
            throw Error("panels outgrow their memory");
        return panels;
    }
    void done(std::size_t layer, Step step) const {
        if (probe) probe(layer, step);
    }

    Sizes sizes(std::uint32_t sequences, std::uint32_t frames) const;
    std::uint32_t reserve(std::uint32_t sequences, std::uint32_t frames);
    void run_layer(std::size_t index, std::uint32_t sequences, std::uint32_t frames);
    void run_residual(std::size_t index, std::uint32_t sequences, std::uint32_t frames);
    void run(const cl::Buffer& motions, std::uint32_t begin, std::uint32_t sequences, std::uint32_t frames,
             const Buffer<float>& features);
};

Recogniser::Network::Network(kernels::Device& on, const Weights& weights, const kernels::Tiles& tiles)
    : device(&on),
      kernels(on, tiles),
      channels(weights.channels),
      joints(weights.joints()),
      classes(weights.classes) {
    const auto folded = fold(weights);
    for (const auto& layer : folded.layers) layers.push_back(place(kernels, layer, joints));
    scale = Buffer<float>(on, to_float(folded.scale));
    shift = Buffer<float>(on, to_float(folded.shift));
    class_weight = Buffer<float>(on, weights.at("fcn.weight"));
    class_bias = Buffer<float>(on, weights.at("fcn.bias"));
}

Sizes Recogniser::Network::sizes(std::uint32_t sequences, std::uint32_t frames) const {
    Sizes out;
    for (const auto& layer : layers) {
        const auto shorter = kernels::strided(frames, layer.stride);
        const auto points = kernels::filtering(layer.stride);
        const std::size_t before = kernels.rows(std::size_t{sequences} * frames);
        const std::size_t after = kernels.rows(std::size_t{sequences} * shorter);
        const std::size_t tiles =
            kernels.rows(std::size_t{joints} * sequences * ((shorter + points.tile - 1) / points.tile));
        const std::size_t narrow = kernels.pitch(layer.in), wide = kernels.pitch(layer.out);
        out.activation = std::max({out.activation, (joints + layer.mixture.count) * before * narrow,
                                   joints * before * wide, joints * after * wide});
        out.spread = std::max({out.spread, joints * after * narrow, points.points_in * tiles * wide});
        out.products = std::max(out.products, points.points_out * tiles * wide);
        if (layer.residual_convolution) out.residual = std::max(out.residual, joints * after * wide);
        frames = shorter;
    }
    return out;
}

/// Makes room for `sequences` at once, or for as many as fit: says how many.
std::uint32_t Recogniser::Network::reserve(std::uint32_t sequences, std::uint32_t frames) {
    sequences = static_cast<std::uint32_t>(std::clamp<std::size_t>(most_frames / frames, 1, sequences));
    while (true) {
        const auto wanted = sizes(sequences, frames);
        if (space.sizes.hold(wanted)) return sequences;
        try {
            space = {};
            space = Workspace(*device, wanted);
            return sequences;
        } catch (const OutOfMemory& e) {
            if (sequences == 1)
                throw OutOfMemory("{}; {} frames are too many there for the recogniser, fewer may do",
                                  e.what(), frames);
            sequences /= 2;
            most_frames = std::size_t{sequences} * frames;
        }
    }
}

void Recogniser::Network::run_residual(std::size_t index, std::uint32_t sequences, std::uint32_t frames) {
    const auto& layer = layers[index];
    const std::size_t rows = std::size_t{sequences} * kernels::strided(frames, layer.stride);
    const auto stepped = view(space.spread, joints, rows, layer.in);
    kernels.gather(view(space.x, joints, std::size_t{sequences} * frames, layer.in), layer.stepped, stepped,
                   0, sequences, frames, layer.stride);
    kernels.multiply(stepped, layer.residual_weight, layer.residual,
                     view(space.residual, joints, rows, layer.out), rows);
    done(index, Step::residual);
}

void Recogniser::Network::run_layer(std::size_t index, std::uint32_t sequences, std::uint32_t frames) {
    const auto& layer = layers[index];
    const auto after = kernels::strided(frames, layer.stride);
    const auto filter = kernels::filtering(layer.stride);
    const std::size_t rows = std::size_t{sequences} * frames, rows_after = std::size_t{sequences} * after;
    const std::size_t tiles = std::size_t{joints} * sequences * ((after + filter.tile - 1) / filter.tile);
    if (layer.residual_convolution) run_residual(index, sequences, frames);

    const auto x = view(space.x, joints + layer.mixture.count, rows, layer.in),
               y = view(space.y, joints, rows, layer.out);
    kernels.gather(x, layer.mixture, x, joints, sequences, frames, 1);
    done(index, Step::gather);
    kernels.multiply_graph(x, layer.graph_weight, layer.graph, layer.graph_bias, y, rows);
    done(index, Step::graph);

    const auto points = view(space.spread, filter.points_in, tiles, layer.out);
    const auto products = view(space.products, filter.points_out, tiles, layer.out);
    kernels.split(y, points, sequences, frames, layer.stride);
    done(index, Step::split);
    kernels.multiply(points, layer.temporal_weight, layer.temporal, products, tiles);
    done(index, Step::temporal);
    const auto residual =
        view(layer.residual_convolution ? space.residual : space.x, joints, rows_after, layer.out);
    const bool adds = layer.residual_convolution || layer.identity_residual;
    kernels.join(products, layer.temporal_bias, adds ? &residual : nullptr,
                 view(space.x_next, joints, rows_after, layer.out), sequences, after, layer.stride);
    done(index, Step::join);
    std::swap(space.x, space.x_next);
}

void Recogniser::Network::run(const cl::Buffer& motions, std::uint32_t begin, std::uint32_t sequences,
                              std::uint32_t frames, const Buffer<float>& features) {
    kernels.enter(motions, scale, shift, view(space.x, joints, std::size_t{sequences} * frames, channels),
                  begin, sequences, channels, frames);
    done(0, Step::enter);
    auto length = frames;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        run_layer(i, sequences, length);
        length = kernels::strided(length, layers[i].stride);
    }
    kernels.pool(view(space.x, joints, std::size_t{sequences} * length, layers.back().out), features, begin,
                 sequences, layers.back().out, length);
    done(layers.size() - 1, Step::pool);
}

Recogniser::Recogniser(kernels::Device& device, const Weights& weights, const kernels::Tiles& tiles)
    : network_(std::make_unique<Network>(device, weights, tiles)) {}
Recogniser::~Recogniser() = default;

Recognised Recogniser::recognise(const cl::Buffer& motions, std::uint32_t sequences, std::uint32_t frames) {
    auto& net = *network_;
    if (frames == 0) throw Error("motions without frames have no features");
    if (sequences == 0) return {};
    const Buffer<float> features(*net.device, std::size_t{sequences} * this->features());
    const Buffer<float> logits(*net.device, std::size_t{sequences} * net.classes);
    const auto together = net.reserve(std::min(sequences, tiles().sequences), frames);
    for (std::uint32_t begin = 0; begin < sequences; begin += together)
        net.run(motions, begin, std::min(together, sequences - begin), frames, features);
    net.kernels.classify(features, net.class_weight, net.class_bias, logits, sequences, this->features(),
                         net.classes);
    return {features.download(), logits.download()};
}

Recognised Recogniser::recognise(std::span<const float> motions, std::uint32_t sequences,
                                 std::uint32_t frames) {
    auto& net = *network_;
    const std::size_t expected = std::size_t{sequences} * net.channels * frames * net.joints;
    if (motions.size() != expected)
        throw Error("{} numbers for {} motions of {} frames, where {} are expected", motions.size(),
                    sequences, frames, expected);
    try {
        return recognise(Buffer<float>(*net.device, motions).memory(), sequences, frames);
    } catch (const OutOfMemory&) {
        if (sequences < 2) throw;
    }
    const auto half = sequences / 2;
    const auto middle = expected / sequences * half;
    auto out = recognise(motions.first(middle), half, frames);
    const auto rest = recognise(motions.subspan(middle), sequences - half, frames);
    out.features.insert(out.features.end(), rest.features.begin(), rest.features.end());
    out.logits.insert(out.logits.end(), rest.logits.begin(), rest.logits.end());
    return out;
}

void Recogniser::watch(std::function<void(std::size_t, Step)> probe) {
    network_->probe = std::move(probe);
}
const kernels::Tiles& Recogniser::tiles() const {
    return network_->kernels.tiles();
}
std::uint32_t Recogniser::channels() const {
    return network_->channels;
}
std::uint32_t Recogniser::joints() const {
    return network_->joints;
}
std::uint32_t Recogniser::features() const {
    return network_->layers.back().out;
}
std::uint32_t Recogniser::classes() const {
    return network_->classes;
}

double direct_operations(const StgcnShape& shape, std::uint32_t frames) {
    double sum = 2.0 * shape.features() * shape.classes;
    for (std::size_t i = 0; i < stgcn_layers; ++i) {
        const auto layer = stgcn_layer(shape, i);
        const double in = layer.in, out = layer.out, joints = shape.joints();
        const auto after = kernels::strided(frames, layer.stride);
        sum += 2 * joints * frames * 3 * in * out + 2 * joints * after * stgcn_taps * out * out;
        if (layer.residual == StgcnLayer::Residual::convolution) sum += 2 * joints * after * in * out;
        frames = after;
    }
    return sum;
}

double multiplied_operations(const StgcnShape& shape, std::uint32_t frames) {
    double panels = 0;
    for (const auto& part : partition(shape.graph))
        for (std::size_t w = 0; w < shape.joints(); ++w) {
            bool any = false;
            for (std::size_t v = 0; v < shape.joints(); ++v) any = any || part[v * shape.joints() + w] != 0;
            panels += any;
        }
    double sum = 2.0 * shape.features() * shape.classes;
    for (std::size_t i = 0; i < stgcn_layers; ++i) {
        const auto layer = stgcn_layer(shape, i);
        const double in = layer.in, out = layer.out, joints = shape.joints();
        const auto after = kernels::strided(frames, layer.stride);
        const auto filter = kernels::filtering(layer.stride);
        const auto tiles_a_joint = (after + filter.tile - 1) / filter.tile;
        sum += 2 * panels * frames * in * out + 2 * joints * tiles_a_joint * filter.points_in * out * out;
        if (layer.residual == StgcnLayer::Residual::convolution) sum += 2 * joints * after * in * out;
        frames = after;
    }
    return sum;
}

}  // namespace actformer::eval
