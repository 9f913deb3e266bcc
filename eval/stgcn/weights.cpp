#include "eval/stgcn/weights.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.hpp"
#include "base/files/aside.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"

namespace actformer::eval {
namespace {

using Shape = std::vector<std::uint64_t>;

constexpr std::int64_t most_channels = 48, most_classes = 100'000, most_joints = 1000;

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

std::vector<float> read_tensor(const hdf5::Reader& file, const std::string& path, const std::string& name,
                               const Shape& expected) {
    const auto stored = file.shape(name);
    if (const Shape shape(stored.begin(), stored.end()); shape != expected)
        throw Error("{}: '{}' is {} where {} is expected", path, name, text_of(shape), text_of(expected));
    auto values = file.read<float>(name);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i]))
            throw Error("{}: '{}' holds {} at {}: training went wrong", path, name, values[i], i);
    if (name.ends_with("running_var") &&
        std::any_of(values.begin(), values.end(), [](float v) { return v < 0; }))
        throw Error("{}: '{}' holds a negative variance", path, name);
    return values;
}

void add_norm(std::map<std::string, Shape>& shapes, const std::string& prefix, std::uint64_t channels) {
    for (const auto* part : {"weight", "bias", "running_mean", "running_var"})
        shapes[prefix + part] = {channels};
}

}  // namespace

std::string layer_prefix(std::size_t layer) {
    return fmt::format("st_gcn_networks.{}.", layer);
}

bool Weights::has_residual_convolution(std::size_t layer) const {
    return layer > 0 && (stgcn_strides[layer] != 1 || widths[layer] != widths[layer - 1]);
}

std::map<std::string, Shape> tensor_shapes(const Weights& weights) {
    std::map<std::string, Shape> shapes;
    const std::uint64_t joints = weights.joints();
    add_norm(shapes, "data_bn.", weights.channels * joints);
    for (std::size_t i = 0; i < stgcn_layers; ++i) {
        const auto prefix = layer_prefix(i);
        const std::uint64_t in = weights.width_before(i), out = weights.widths[i];
        shapes[prefix + "gcn.conv.weight"] = {3 * out, in, 1, 1};
        shapes[prefix + "gcn.conv.bias"] = {3 * out};
        add_norm(shapes, prefix + "tcn.0.", out);
        shapes[prefix + "tcn.2.weight"] = {out, out, stgcn_taps, 1};
        shapes[prefix + "tcn.2.bias"] = {out};
        add_norm(shapes, prefix + "tcn.3.", out);
        if (weights.has_residual_convolution(i)) {
            shapes[prefix + "residual.0.weight"] = {out, in, 1, 1};
            shapes[prefix + "residual.0.bias"] = {out};
            add_norm(shapes, prefix + "residual.1.", out);
        }
        shapes[fmt::format("edge_importance.{}", i)] = {3, joints, joints};
    }
    shapes["fcn.weight"] = {weights.classes, weights.features(), 1, 1};
    shapes["fcn.bias"] = {weights.classes};
    return shapes;
}

Weights read_weights(const std::filesystem::path& file_path) {
    const auto path = file_path.string();
    const hdf5::Reader file(file_path);
    Weights weights;
    weights.source = path;
    weights.channels = one_number(file, path, "channels", 1, most_channels);
    weights.classes = one_number(file, path, "classes", 1, most_classes);
    weights.parents = read_parents(file, path);
    weights.center =
        one_number(file, path, "center", 0, static_cast<std::int64_t>(weights.parents.size()) - 1);
    for (std::size_t i = 0; i < stgcn_layers; ++i) weights.widths[i] = read_width(file, path, i);
    const auto shapes = tensor_shapes(weights);
    for (const auto& name : file.names())
        if (!shapes.contains(name))
            throw Error("{}: '{}' is no part of a recogniser of these channels and joints", path, name);
    for (const auto& [name, shape] : shapes) weights.tensors[name] = read_tensor(file, path, name, shape);
    return weights;
}

void write_weights(const std::filesystem::path& path, const Weights& weights) {
    Aside aside(path);
    hdf5::Writer file(aside.partial());
    for (const auto& [name, shape] : tensor_shapes(weights))
        file.write<float>(name, hdf5::Shape(shape.begin(), shape.end()), weights.at(name));
    file.attribute("channels", std::int64_t{weights.channels});
    file.attribute("classes", std::int64_t{weights.classes});
    file.attribute("parents", std::vector<std::int64_t>(weights.parents.begin(), weights.parents.end()));
    file.attribute("center", std::int64_t{weights.center});
    aside.commit(file.finish());
}

Weights random_weights(std::uint32_t channels, std::uint32_t classes, const std::vector<int>& parents,
                       std::uint32_t center, double width, std::uint32_t seed) {
    Weights weights;
    weights.source = "random weights";
    weights.channels = channels;
    weights.classes = classes;
    weights.parents = parents;
    weights.center = center;
    for (std::size_t i = 0; i < stgcn_layers; ++i)
        weights.widths[i] = static_cast<std::uint32_t>(std::lround(width * (i < 4 ? 64 : i < 7 ? 128 : 256)));
    std::mt19937 random(seed);
    for (const auto& [name, shape] : tensor_shapes(weights)) {
        double mean = 0, deviation = 0.1;
        if (name.ends_with("running_var") || name.starts_with("edge_importance") ||
            (name.ends_with(".weight") && shape.size() == 1))
            mean = 1;
        else if (shape.size() > 1)
            deviation = std::sqrt(2.0 / static_cast<double>(shape[1] * shape[2] * shape[3]));
        std::size_t count = 1;
        for (const auto extent : shape) count *= extent;
        std::normal_distribution<float> normal(static_cast<float>(mean), static_cast<float>(deviation));
        std::vector<float> values(count);
        for (auto& value : values) value = normal(random);
        weights.tensors[name] = std::move(values);
    }
    return weights;
}

std::filesystem::path weights_of(const std::filesystem::path& recogniser) {
    if (!std::filesystem::is_directory(recogniser)) return recogniser;
    const auto best = recogniser / "weights-best.h5";
    return std::filesystem::exists(best) ? best : recogniser / "weights-last.h5";
}

const std::vector<int> ntu_edges{-1, 0,  20, 2, 20, 4,  5,  6, 20, 8, 9,  10, 0,
                                 12, 13, 14, 0, 16, 17, 18, 1, 22, 7, 24, 11};

}  // namespace actformer::eval
