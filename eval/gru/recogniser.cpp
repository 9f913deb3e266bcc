#include "eval/gru/recogniser.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/random/philox.hpp"

namespace actformer::eval {
namespace {

using kernels::Buffer;

/// (rows, columns) -> (columns, rows)
std::vector<float> transposed(const std::vector<float>& values, std::size_t rows) {
    const auto columns = values.size() / rows;
    std::vector<float> out(values.size());
    for (std::size_t r = 0; r < rows; ++r)
        for (std::size_t c = 0; c < columns; ++c) out[c * rows + r] = values[r * columns + c];
    return out;
}

kernels::GruWeights place(kernels::Device& device, const GruFile& weights, std::size_t layer) {
    const auto of = [&](const char* name) {
        return weights.at(fmt::format("recurrent.{}_l{}", name, layer));
    };
    const std::size_t gates = 3 * std::size_t{weights.network.hidden};
    auto bias = of("bias_ih");
    const auto of_state = of("bias_hh");
    bias.insert(bias.end(), of_state.begin(), of_state.end());
    return {Buffer<float>(device, transposed(of("weight_ih"), gates)),
            Buffer<float>(device, transposed(of("weight_hh"), gates)), Buffer<float>(device, bias)};
}

/// Two normal numbers of a place (Box and Muller).
std::array<float, 2> normals(std::uint64_t seed, std::uint64_t sequence, std::uint32_t layer,
                             std::uint32_t at) {
    const auto words =
        philox({at, layer, static_cast<std::uint32_t>(sequence), static_cast<std::uint32_t>(sequence >> 32U)},
               {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)});
    const double radius = std::sqrt(-2 * std::log((words[0] + 0.5) * 0x1p-32)),
                 angle = 2 * std::numbers::pi * words[1] * 0x1p-32;
    return {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))};
}

}  // namespace

GruRecogniser::GruRecogniser(kernels::Device& device, const GruFile& weights, std::uint32_t batch,
                             std::optional<std::uint64_t> initial_noise)
    : Recogniser(device, {"gru", weights.source, weights.representation, weights.channels, weights.classes,
                          weights.network.features, weights.parents, weights.class_names}),
      network_(weights.network),
      batch_(std::max(batch, 1U)),
      noise_(initial_noise),
      kernels_(device, weights.network.hidden),
      feature_weight_(device, weights.at("linear1.weight")),
      feature_bias_(device, weights.at("linear1.bias")),
      class_weight_(device, weights.at("linear2.weight")),
      class_bias_(device, weights.at("linear2.bias")) {
    for (std::size_t l = 0; l < gru_layers; ++l) layers_.push_back(place(device, weights, l));
}

Buffer<float> GruRecogniser::initial(std::uint32_t begin, std::uint32_t count, std::size_t layer) const {
    std::vector<float> values(std::size_t{count} * network_.hidden, 0.0F);
    if (noise_)
        for (std::uint32_t n = 0; n < count; ++n)
            for (std::uint32_t i = 0; i < network_.hidden; i += 2) {
                const auto pair = normals(*noise_, next_ + begin + n, static_cast<std::uint32_t>(layer), i);
                std::copy(pair.begin(), pair.end(), values.begin() + n * network_.hidden + i);
            }
    return {device(), values};
}

void GruRecogniser::begin_set(const std::string& name) {
    next_ = std::stoull(checksum(name).substr(0, 16), nullptr, 16);
}

void GruRecogniser::run(const cl::Buffer& motions, std::uint32_t begin, std::uint32_t count,
                        std::uint32_t frames, const Buffer<float>& features) {
    const auto& about = info();
    const auto moving = about.representation.moving(about.joints());
    const kernels::MotionLayout layout{about.channels, frames, about.joints(),
                                       about.representation.numbers()};
    const std::size_t rows = std::size_t{count} * frames;
    Buffer<float> x(device(), rows * network_.inputs);
    kernels_.poses(motions, layout, {moving.root, moving.first, moving.count}, begin, count, x);
    auto inputs = network_.inputs;
    for (std::size_t l = 0; l < gru_layers; ++l) {
        const Buffer<float> states(device(), rows * network_.hidden), start = initial(begin, count, l);
        kernels_.layer(x, start, layers_[l], count, frames, inputs, states);
        x = states;
        inputs = network_.hidden;
    }
    kernels_.dense(x,
                   {count, network_.hidden, (frames - 1) * network_.hidden, frames * network_.hidden, begin},
                   feature_weight_, feature_bias_, true, features);
    device().queue().finish();  // what this call made room for is free again
}

Recognised GruRecogniser::recognise(const cl::Buffer& motions, std::uint32_t sequences,
                                    std::uint32_t frames) {
    if (frames == 0) throw Error("motions without frames have no features");
    if (sequences == 0) return {};
    const Buffer<float> features(device(), std::size_t{sequences} * network_.features);
    const Buffer<float> logits(device(), std::size_t{sequences} * network_.classes);
    for (std::uint32_t begin = 0; begin < sequences; begin += batch_) {
        const auto count = std::min(batch_, sequences - begin);
        run(motions, begin, count, frames, features);
    }
    next_ += sequences;
    kernels_.dense(features, {sequences, network_.features, 0, network_.features, 0}, class_weight_,
                   class_bias_, false, logits);
    return {features.download(), logits.download()};
}

std::unique_ptr<Recogniser> open_gru(kernels::Device& device, const std::filesystem::path& weights,
                                     std::uint32_t batch, std::optional<std::uint64_t> initial_noise) {
    return std::make_unique<GruRecogniser>(device, read_gru_weights(weights), batch, initial_noise);
}

}  // namespace actformer::eval
