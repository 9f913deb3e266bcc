#include "model/recognisers/import_recogniser.hpp"

#include <algorithm>
#include <optional>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "eval/stgcn/network.hpp"
#include "eval/weights_writer.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/subjects.hpp"
#include "model/nn/torch_arrays.hpp"
#include "model/nn/weights_file.hpp"

namespace actformer::model {
namespace {

/// What the weights must fit.
struct Motions {
    ingest::Subjects subjects;
    std::vector<int> parents;
    std::string where;  ///< the file, for error messages

    std::uint32_t channels() const { return subjects.persons * subjects.representation.numbers(); }
    std::uint32_t classes() const { return static_cast<std::uint32_t>(subjects.classes.size()); }
};

struct Expected {
    std::string name;
    std::vector<std::int64_t> shape;
};

/// A kind of recogniser as one checkpoint has it.
struct Network {
    std::string kind;
    std::vector<Expected> arrays;
    std::vector<int> parents;
    std::optional<std::uint32_t> centre;  ///< of an ST-GCN's graph
};

/// Behind all layers: a weight's rows are the classes.
void check_classes(const std::vector<Array>& arrays, const std::string& last, const Motions& motions) {
    const auto found = std::ranges::find(arrays, last, &Array::name);
    if (found != arrays.end() && !found->shape.empty() && found->shape[0] != motions.classes())
        throw Error(
            "{}: weights for {} classes, and the dataset has {}; give one with the classes it was trained on",
            motions.where, found->shape[0], motions.classes());
}

/// Two layers of GRU cells and two dense ones; none where the arrays are another network's.
std::optional<Network> gru_of(const std::vector<Array>& arrays, const Motions& motions) {
    const auto hidden = matrix_shape(arrays, "recurrent.weight_hh_l0").second;
    if (hidden == 0) return std::nullopt;
    check_classes(arrays, "linear2.weight", motions);
    const auto features = matrix_shape(arrays, "linear1.weight").first;
    const std::int64_t inputs = std::int64_t{motions.channels()} *
                                static_cast<std::int64_t>(motions.parents.size()),
                       classes = motions.classes();
    Network network{"gru", {}, motions.parents, {}};
    for (const auto layer : {0, 1}) {
        const auto add = [&](const char* name, std::vector<std::int64_t> shape) {
            network.arrays.push_back({fmt::format("recurrent.{}_l{}", name, layer), std::move(shape)});
        };
        add("weight_ih", {3 * hidden, layer == 0 ? inputs : hidden});
        add("weight_hh", {3 * hidden, hidden});
        add("bias_ih", {3 * hidden});
        add("bias_hh", {3 * hidden});
    }
    for (const auto& [name, out, in] :
         {std::tuple{"linear1", features, hidden}, std::tuple{"linear2", classes, features}}) {
        network.arrays.push_back({fmt::format("{}.weight", name), {out, in}});
        network.arrays.push_back({fmt::format("{}.bias", name), {out}});
    }
    return network;
}

std::optional<Network> stgcn_of(const std::vector<Array>& arrays, const Motions& motions) {
    eval::StgcnShape shape;
    for (std::size_t i = 0; i < eval::stgcn_layers; ++i) {
        const auto found = std::ranges::find(arrays, eval::layer_prefix(i) + "tcn.2.weight", &Array::name);
        if (found == arrays.end() || found->shape.size() != 4) return std::nullopt;
        shape.widths[i] = static_cast<std::uint32_t>(found->shape[0]);
    }
    check_classes(arrays, "fcn.weight", motions);
    shape.channels = motions.channels();
    shape.classes = motions.classes();
    shape.graph = eval::recogniser_graph(motions.parents);
    Network network{"stgcn", {}, shape.graph.parents, shape.graph.center};
    for (const auto& tensor : eval::stgcn_tensors(shape))
        network.arrays.push_back({tensor.name, {tensor.shape.begin(), tensor.shape.end()}});
    return network;
}

/// Those that the network has, in its order.
std::vector<Array> taken(const std::vector<Array>& arrays, const Network& network, const std::string& where) {
    std::vector<Array> out;
    for (const auto& wanted : network.arrays) {
        const auto found = std::ranges::find(arrays, wanted.name, &Array::name);
        if (found == arrays.end()) throw Error("{}: holds no '{}'", where, wanted.name);
        if (found->shape != wanted.shape)
            throw Error("{}: '{}' is ({}), and for the dataset's motions ({}) is expected", where,
                        wanted.name, fmt::join(found->shape, ", "), fmt::join(wanted.shape, ", "));
        out.push_back(*found);
    }
    return out;
}

std::pair<Network, std::vector<Array>> recognised(const TorchArrays& file, const Motions& motions) {
    for (const auto& prefix : file.prefixes) {
        const auto arrays = file.behind(prefix);
        for (const auto kind : {gru_of, stgcn_of})
            if (const auto network = kind(arrays, motions))
                return {*network, taken(arrays, *network, motions.where)};
    }
    throw Error("{}: holds neither an ST-GCN nor a GRU classifier; it has {}", motions.where,
                file.arrays.empty() ? "no tensors" : names_of(file.arrays));
}

}  // namespace

ImportedRecogniser import_recogniser(const ImportRecogniserRequest& request) {
    const auto arrays = read_torch_arrays(request.file);
    const ingest::Dataset dataset(ingest::one_dataset_at(request.data));
    Motions motions{ingest::subjects_of(dataset), {}, request.file.string()};
    motions.parents = motions.subjects.representation.node_parents(motions.subjects.topology);
    const auto [network, weights] = recognised(arrays, motions);
    auto file = weights_writer(weights);
    eval::write_recogniser_attributes(file, network.kind,
                                      {motions.channels(), motions.classes(), network.parents,
                                       motions.subjects.representation, motions.subjects.classes},
                                      network.centre);
    file.attribute("program", std::string("actformer " ACTFORMER_VERSION));
    file.attribute("imported", request.file.filename().string());
    file.attribute("imported_checksum", checksum_file(request.file));
    write_whole(request.out, file.checked_image());
    std::uint64_t numbers = 0;
    for (const auto& weight : weights)
        numbers += std::visit([](const auto& v) { return v.size(); }, weight.values);
    return {network.kind, numbers, motions.classes()};
}

}  // namespace actformer::model
