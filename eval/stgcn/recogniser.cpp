#include "eval/stgcn/recogniser.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "base/error.hpp"
#include "eval/stgcn/device_layer.hpp"
#include "eval/stgcn/tuning.hpp"

namespace actformer::eval {
namespace {

using kernels::Buffer;
using kernels::Panels;

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

struct StgcnRecogniser::Network {
    kernels::Device* device;
    kernels::Stgcn kernels;
    std::uint32_t channels, joints;
    std::vector<DeviceLayer> layers;
    Buffer<float> scale, shift, class_weight, class_bias;
    Workspace space;
    std::size_t most_frames =
        std::numeric_limits<std::size_t>::max();  // sequences x frames that were found to fit
    std::function<void(std::size_t, Step)> probe;

    Network(kernels::Device& on, const StgcnWeights& weights, const kernels::Tiles& tiles);

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

StgcnRecogniser::Network::Network(kernels::Device& on, const StgcnWeights& weights,
                                  const kernels::Tiles& tiles)
    : device(&on), kernels(on, tiles), channels(weights.channels), joints(weights.joints()) {
    const auto folded = fold(weights);
    for (const auto& layer : folded.layers) layers.push_back(place(kernels, layer, joints));
    scale = Buffer<float>(on, to_float(folded.scale));
    shift = Buffer<float>(on, to_float(folded.shift));
    class_weight = Buffer<float>(on, weights.at("fcn.weight"));
    class_bias = Buffer<float>(on, weights.at("fcn.bias"));
}

Sizes StgcnRecogniser::Network::sizes(std::uint32_t sequences, std::uint32_t frames) const {
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
std::uint32_t StgcnRecogniser::Network::reserve(std::uint32_t sequences, std::uint32_t frames) {
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

void StgcnRecogniser::Network::run_residual(std::size_t index, std::uint32_t sequences,
                                            std::uint32_t frames) {
    const auto& layer = layers[index];
    const std::size_t rows = std::size_t{sequences} * kernels::strided(frames, layer.stride);
    const auto stepped = view(space.spread, joints, rows, layer.in);
    kernels.gather(view(space.x, joints, std::size_t{sequences} * frames, layer.in), layer.stepped, stepped,
                   0, sequences, frames, layer.stride);
    kernels.multiply(stepped, layer.residual_weight, layer.residual,
                     view(space.residual, joints, rows, layer.out), rows);
    done(index, Step::residual);
}

void StgcnRecogniser::Network::run_layer(std::size_t index, std::uint32_t sequences, std::uint32_t frames) {
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
    kernels.transform_input(y, points, sequences, frames, layer.stride);
    done(index, Step::transform_input);
    kernels.multiply(points, layer.temporal_weight, layer.temporal, products, tiles);
    done(index, Step::temporal);
    const auto residual =
        view(layer.residual_convolution ? space.residual : space.x, joints, rows_after, layer.out);
    const bool adds = layer.residual_convolution || layer.identity_residual;
    kernels.transform_output(products, layer.temporal_bias, adds ? &residual : nullptr,
                             view(space.x_next, joints, rows_after, layer.out), sequences, after,
                             layer.stride);
    done(index, Step::transform_output);
    std::swap(space.x, space.x_next);
}

void StgcnRecogniser::Network::run(const cl::Buffer& motions, std::uint32_t begin, std::uint32_t sequences,
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

StgcnRecogniser::StgcnRecogniser(kernels::Device& device, const StgcnWeights& weights,
                                 const kernels::Tiles& tiles)
    : Recogniser(device, {"stgcn", weights.source, weights.representation, weights.channels, weights.classes,
                          weights.features(), weights.graph.parents, weights.class_names}),
      network_(std::make_unique<Network>(device, weights, tiles)) {}
StgcnRecogniser::~StgcnRecogniser() = default;

Recognised StgcnRecogniser::recognise(const cl::Buffer& motions, std::uint32_t sequences,
                                      std::uint32_t frames) {
    auto& net = *network_;
    if (frames == 0) throw Error("motions without frames have no features");
    if (sequences == 0) return {};
    const Buffer<float> features(device(), std::size_t{sequences} * info().features);
    const Buffer<float> logits(device(), std::size_t{sequences} * info().classes);
    const auto together = net.reserve(std::min(sequences, tiles().sequences), frames);
    for (std::uint32_t begin = 0; begin < sequences; begin += together)
        net.run(motions, begin, std::min(together, sequences - begin), frames, features);
    net.kernels.classify(features, net.class_weight, net.class_bias, logits, sequences, info().features,
                         info().classes);
    return {features.download(), logits.download()};
}

void StgcnRecogniser::watch(std::function<void(std::size_t, Step)> probe) {
    network_->probe = std::move(probe);
}

const kernels::Tiles& StgcnRecogniser::tiles() const {
    return network_->kernels.tiles();
}

std::unique_ptr<Recogniser> open_stgcn(kernels::Device& device, const std::filesystem::path& weights,
                                       std::uint32_t batch) {
    auto tiles = load_tiles(device.info());
    tiles.sequences = std::min(tiles.sequences, batch);
    return std::make_unique<StgcnRecogniser>(device, read_stgcn_weights(weights), tiles);
}

}  // namespace actformer::eval
