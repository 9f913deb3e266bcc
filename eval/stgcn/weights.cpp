#include "eval/stgcn/weights.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.hpp"
#include "base/files/aside.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "ingest/dataset/subjects.hpp"

namespace actformer::eval {
namespace {

using Shape = std::vector<std::uint64_t>;

constexpr std::int64_t most_channels = 96, most_classes = 100'000, most_joints = 1000;

std::string text_of(const Shape& shape) {
    return fmt::format("({})", fmt::join(shape, ", "));
}

std::uint32_t one_number(const hdf5::Reader& file, const std::string& path, const std::string& name,
                         std::int64_t least, std::int64_t most) {
    const auto values = file.attribute_numbers(name);
    if (values.size() != 1 || values[0] < least || values[0] > most)
        throw Error("{}: attribute '{}' is not one number from {} to {}", path, name, least, most);
    return static_cast<std::uint32_t>(values[0]);
}

std::vector<int> read_parents(const hdf5::Reader& file, const std::string& path) {
    const auto values = file.attribute_numbers("parents");
    const auto count = static_cast<std::int64_t>(values.size());
    if (count == 0 || count > most_joints)
        throw Error("{}: attribute 'parents' lists {} joints", path, count);
    for (std::size_t k = 0; k < values.size(); ++k)
        if (values[k] < -1 || values[k] >= count)
            throw Error("{}: attribute 'parents' is no tree: joint {} hangs from {}, which is not there",
                        path, k, values[k]);
    if (const auto roots = std::count(values.begin(), values.end(), -1); roots != 1)
        throw Error("{}: attribute 'parents' is no tree: {} joints have -1, and one root is expected", path,
                    roots);
    for (std::size_t k = 0; k < values.size(); ++k) {
        std::int64_t at = static_cast<std::int64_t>(k), steps = 0;
        while (at >= 0 && steps++ <= count) at = values[static_cast<std::size_t>(at)];
        if (at >= 0) throw Error("{}: attribute 'parents' is no tree: joint {} hangs from itself", path, k);
    }
    return {values.begin(), values.end()};
}

/// A layer's channels from the one tensor that tells them; its exact shape is checked with all others later.
std::uint32_t read_width(const hdf5::Reader& file, const std::string& path, std::size_t layer) {
    const auto name = layer_prefix(layer) + "tcn.2.weight";
    const auto shape = file.shape(name);
    if (shape.size() != 4 || shape[0] == 0 || shape[0] > 65536)
        throw Error("{}: '{}' is no (channels, channels, {}, 1) array", path, name, stgcn_taps);
    return static_cast<std::uint32_t>(shape[0]);
}

std::vector<float> read_tensor(const hdf5::Reader& file, const std::string& path, const StgcnTensor& tensor) {
    const auto& name = tensor.name;
    const auto stored = file.shape(name);
    if (const Shape shape(stored.begin(), stored.end()); shape != tensor.shape)
        throw Error("{}: '{}' is {} where {} is expected", path, name, text_of(shape), text_of(tensor.shape));
    auto values = file.read<float>(name);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i]))
            throw Error("{}: '{}' holds {} at {}: training went wrong", path, name, values[i], i);
    if (tensor.role == TensorRole::running_variance &&
        std::any_of(values.begin(), values.end(), [](float v) { return v < 0; }))
        throw Error("{}: '{}' holds a negative variance", path, name);
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

Weights read_weights(const std::filesystem::path& file_path) {
    const auto path = file_path.string();
    const hdf5::Reader file(file_path);
    Weights weights;
    weights.source = path;
    weights.channels = one_number(file, path, "channels", 1, most_channels);
    weights.classes = one_number(file, path, "classes", 1, most_classes);
    weights.representation = ingest::read_representation(file, path).value_or(ingest::Representation::limb);
    if (file.has_attribute("class_names")) weights.class_names = file.attribute_texts("class_names");
    if (!weights.class_names.empty() && weights.class_names.size() != weights.classes)
        throw Error("{}: attribute 'class_names' names {} of {} classes", path, weights.class_names.size(),
                    weights.classes);
    weights.graph.parents = read_parents(file, path);
    weights.graph.center = one_number(file, path, "center", 0, std::int64_t{weights.joints()} - 1);
    for (std::size_t i = 0; i < stgcn_layers; ++i) weights.widths[i] = read_width(file, path, i);
    const auto tensors = stgcn_tensors(weights);
    for (const auto& name : file.names())
        if (!known(tensors, name))
            throw Error("{}: '{}' is no part of a recogniser of these channels and joints", path, name);
    for (const auto& tensor : tensors) weights.tensors[tensor.name] = read_tensor(file, path, tensor);
    return weights;
}

void write_weights(const std::filesystem::path& path, const Weights& weights) {
    Aside aside(path);
    hdf5::Writer file(aside.partial());
    for (const auto& [name, shape, role, fan_in] : stgcn_tensors(weights))
        file.write<float>(name, hdf5::Shape(shape.begin(), shape.end()), weights.at(name));
    file.attribute("kind", std::string("stgcn"));
    file.attribute("representation", weights.representation.name());
    if (!weights.class_names.empty()) file.attribute("class_names", weights.class_names);
    file.attribute("channels", std::int64_t{weights.channels});
    file.attribute("classes", std::int64_t{weights.classes});
    file.attribute("parents",
                   std::vector<std::int64_t>(weights.graph.parents.begin(), weights.graph.parents.end()));
    file.attribute("center", std::int64_t{weights.graph.center});
    aside.commit(file.finish());
}

Weights random_weights(std::uint32_t channels, std::uint32_t classes, const Graph& graph, double width,
                       std::uint32_t seed) {
    Weights weights;
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
