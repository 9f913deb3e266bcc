#include "eval/stgcn/weights.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "eval/metrics/confusion.hpp"
#include "eval/weights_reader.hpp"
#include "eval/weights_writer.hpp"

namespace actformer::eval {
namespace {

/// A layer's channels from the one tensor that tells them; its exact shape is checked with all others later.
std::uint32_t read_width(const hdf5::Reader& file, const std::string& path, std::size_t layer) {
    const auto name = layer_prefix(layer) + "tcn.2.weight";
    const auto shape = file.shape(name);
    if (shape.size() != 4 || shape[0] == 0 || shape[0] > 65536)
        throw Error("{}: '{}' is no (channels, channels, {}, 1) array", path, name, stgcn_taps);
    return static_cast<std::uint32_t>(shape[0]);
}

std::vector<float> read_stgcn_tensor(const hdf5::Reader& file, const std::string& path,
                                     const StgcnTensor& tensor) {
    auto values = read_tensor(file, path, tensor.name, tensor.shape);
    if (tensor.role == TensorRole::running_variance &&
        std::any_of(values.begin(), values.end(), [](float v) { return v < 0; }))
        throw Error("{}: '{}' holds a negative variance", path, tensor.name);
    return values;
}

bool known(const std::vector<StgcnTensor>& tensors, const std::string& name) {
    return std::any_of(tensors.begin(), tensors.end(),
                       [&](const StgcnTensor& tensor) { return tensor.name == name; });
}

/// Mean and deviation of a tensor's random numbers.
std::pair<double, double> spread_of(const StgcnTensor& tensor) {
    switch (tensor.role) {
        case TensorRole::weight:
            return {0, std::sqrt(2.0 / static_cast<double>(tensor.fan_in))};
        case TensorRole::importance:
        case TensorRole::gain:
        case TensorRole::running_variance:
            return {1, 0.1};
        default:
            return {0, 0.1};
    }
}

}  // namespace

StgcnWeights read_stgcn_weights(const std::filesystem::path& file_path) {
    const auto path = file_path.string();
    const hdf5::Reader file(file_path);
    StgcnWeights weights;
    weights.source = path;
    auto about = read_attributes(file, path);
    check_class_count(about.classes, path);
    weights.channels = about.channels;
    weights.classes = about.classes;
    weights.representation = about.representation;
    weights.class_names = std::move(about.class_names);
    weights.graph.parents = std::move(about.parents);
    weights.graph.center = one_number(file, path, "center", 0, std::int64_t{weights.joints()} - 1);
    for (std::size_t i = 0; i < stgcn_layers; ++i) weights.widths[i] = read_width(file, path, i);
    const auto tensors = stgcn_tensors(weights);
    for (const auto& name : file.names())
        if (!known(tensors, name))
            throw Error("{}: '{}' is no part of a recogniser of these channels and joints", path, name);
    for (const auto& tensor : tensors) weights.tensors[tensor.name] = read_stgcn_tensor(file, path, tensor);
    return weights;
}

void write_stgcn_weights(const std::filesystem::path& path, const StgcnWeights& weights) {
    hdf5::Writer file(path);
    for (const auto& [name, shape, role, fan_in] : stgcn_tensors(weights))
        file.write<float>(name, hdf5::Shape(shape.begin(), shape.end()), weights.at(name));
    write_recogniser_attributes(file, "stgcn",
                                {weights.channels, weights.classes, weights.graph.parents,
                                 weights.representation, weights.class_names},
                                weights.graph.center);
    file.finish();
}

StgcnWeights random_stgcn_weights(std::uint32_t channels, std::uint32_t classes, const Graph& graph,
                                  double width, std::uint32_t seed) {
    StgcnWeights weights;
    weights.source = "random weights";
    weights.channels = channels;
    weights.classes = classes;
    weights.graph = graph;
    for (std::size_t i = 0; i < stgcn_layers; ++i)
        weights.widths[i] = static_cast<std::uint32_t>(std::lround(width * stgcn_channels[i]));
    auto tensors = stgcn_tensors(weights);
    std::sort(tensors.begin(), tensors.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    std::mt19937 random(seed);
    for (const auto& tensor : tensors) {
        const auto [mean, deviation] = spread_of(tensor);
        std::normal_distribution<float> normal(static_cast<float>(mean), static_cast<float>(deviation));
        std::vector<float> values(tensor.count());
        for (auto& value : values) value = normal(random);
        weights.tensors[tensor.name] = std::move(values);
    }
    return weights;
}

}  // namespace actformer::eval
