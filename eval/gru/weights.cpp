#include "eval/gru/weights.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "eval/metrics/confusion.hpp"

namespace actformer::eval {
namespace {

/// A state is whole vectors, and a group of work-items on every device.
constexpr std::uint64_t hidden_step = 16, most_hidden = 256, most_features = 4096;

/// A matrix's rows and columns; {0, 0} for what is none.
std::array<std::uint64_t, 2> matrix(const hdf5::Reader& file, const std::string& name) {
    const auto shape = file.shape(name);
    return shape.size() == 2 ? std::array<std::uint64_t, 2>{shape[0], shape[1]}
                             : std::array<std::uint64_t, 2>{};
}

/// Sizes that the tensors alone tell; their exact shapes are checked with all others later.
GruNetwork network_of(const hdf5::Reader& file, const RecogniserAttributes& about, const std::string& path) {
    const auto hidden = matrix(file, "recurrent.weight_hh_l0")[1],
               features = matrix(file, "linear1.weight")[0];
    if (hidden == 0 || hidden % hidden_step != 0 || hidden > most_hidden)
        throw Error("{}: 'recurrent.weight_hh_l0' has {} columns, and a multiple of {} up to {} is expected",
                    path, hidden, hidden_step, most_hidden);
    if (features == 0 || features > most_features)
        throw Error("{}: 'linear1.weight' has {} rows, and 1 to {} are expected", path, features,
                    most_features);
    return {about.channels * static_cast<std::uint32_t>(about.parents.size()),
            static_cast<std::uint32_t>(hidden), static_cast<std::uint32_t>(features), about.classes};
}

}  // namespace

std::uint64_t GruTensor::count() const {
    return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
}

std::vector<GruTensor> gru_tensors(const GruNetwork& network) {
    const std::uint64_t hidden = network.hidden;
    std::vector<GruTensor> all;
    for (std::size_t l = 0; l < gru_layers; ++l) {
        const auto add = [&](const char* name, TensorShape shape) {
            all.push_back({fmt::format("recurrent.{}_l{}", name, l), std::move(shape), hidden});
        };
        add("weight_ih", {3 * hidden, l == 0 ? network.inputs : hidden});
        add("weight_hh", {3 * hidden, hidden});
        add("bias_ih", {3 * hidden});
        add("bias_hh", {3 * hidden});
    }
    const auto dense = [&](const std::string& name, std::uint64_t out, std::uint64_t in) {
        all.push_back({name + ".weight", {out, in}, in});
        all.push_back({name + ".bias", {out}, in});
    };
    dense("linear1", network.features, hidden);
    dense("linear2", network.classes, network.features);
    return all;
}

GruFile read_gru_weights(const std::filesystem::path& path) {
    const hdf5::Reader file(path);
    GruFile weights;
    weights.source = path.string();
    static_cast<RecogniserAttributes&>(weights) = read_attributes(file, weights.source);
    check_class_count(weights.classes, weights.source);
    if (weights.channels % weights.representation.numbers() != 0)
        throw Error("{}: attribute 'channels' is {}, and {} has {} numbers a node and person", weights.source,
                    weights.channels, weights.representation.name(), weights.representation.numbers());
    weights.network = network_of(file, weights, weights.source);
    const auto tensors = gru_tensors(weights.network);
    for (const auto& name : file.names())
        if (std::ranges::find(tensors, name, &GruTensor::name) == tensors.end())
            throw Error("{}: '{}' is no part of a GRU recogniser", weights.source, name);
    for (const auto& tensor : tensors)
        weights.tensors[tensor.name] = read_tensor(file, weights.source, tensor.name, tensor.shape);
    return weights;
}

}  // namespace actformer::eval
