#include "model/recognisers/stgcn_net.hpp"

#include <ATen/CPUGeneratorImpl.h>
#include <ATen/core/grad_mode.h>

#include "base/error.hpp"
#include "base/random/splitmix.hpp"
#include "model/nn/fused_layers.hpp"
#include "model/nn/tensor_array.hpp"

namespace actformer::model {
namespace {

using Residual = eval::StgcnLayer::Residual;

constexpr double norm_momentum = 0.1, norm_epsilon = 1e-5;

/// Uniform numbers are drawn in float32; a WeightStore, which draws in double, would begin with others.
at::Tensor started_in_float(const NetworkWeight& weight, at::Generator& random) {
    auto values = at::zeros(weight.shape, at::kFloat);
    if (weight.init == Init::ones) values.fill_(1);
    if (weight.init == Init::uniform) values.uniform_(-weight.scale, weight.scale, random);
    return values;
}

/// (3, K, K) float32, whatever the network's type: weights of either meet the same numbers.
at::Tensor partition_tensor(const eval::Graph& graph) {
    const std::int64_t joints = graph.joints();
    std::vector<float> values;
    for (const auto& part : eval::partition(graph)) values.insert(values.end(), part.begin(), part.end());
    return at::from_blob(values.data(), {3, joints, joints}, at::kFloat).clone();
}

}  // namespace

StgcnNet::StgcnNet(StgcnSettings settings, std::uint64_t seed, const at::Device& device, at::ScalarType type)
    : settings_(std::move(settings)), shape_(shape_of(settings_)), declared_(stgcn_weights(settings_)) {
    check(settings_);
    partition_ = partition_tensor(settings_.graph).to(device, type);
    edge_index_ = partition_.view(-1).nonzero().view(-1);
    edges_ = partition_.nonzero().to(at::kInt).contiguous();
    auto random = at::make_generator<at::CPUGeneratorImpl>(seed);
    for (const auto& weight : declared_)
        weights_[weight.name] =
            started_in_float(weight, random).to(device, type).set_requires_grad(weight.trained);
}

at::Tensor StgcnNet::norm(const at::Tensor& x, const std::string& name, Mode mode) const {
    return at::batch_norm(x, weight(name + ".weight"), weight(name + ".bias"), weight(name + ".running_mean"),
                          weight(name + ".running_var"), mode == Mode::train, norm_momentum, norm_epsilon,
                          true);
}

at::Tensor StgcnNet::convolution(const at::Tensor& x, const std::string& name, std::int64_t stride) const {
    const auto& kernel = weight(name + ".weight");
    return at::conv2d(x, kernel, weight(name + ".bias"), {stride, 1}, {kernel.size(2) / 2, 0});
}

at::Tensor StgcnNet::edge_strengths(std::size_t layer) const {
    return partition_ * weight(fmt::format("edge_importance.{}", layer));
}

at::Tensor StgcnNet::layer(const at::Tensor& x, std::size_t i, Mode mode) const {
    const auto layer = eval::stgcn_layer(shape_, i);
    const auto prefix = eval::layer_prefix(i);
    const auto n = x.size(0), t = x.size(2), k = x.size(3), out = std::int64_t{layer.out};

    // Every part's own 1x1 convolution, then the sum over parts and source joints into the target joints.
    auto y = convolution(x, prefix + "gcn.conv", 1).view({n, 3, out, t, k});
    y = y.permute({0, 2, 3, 1, 4}).reshape({n, out, t, 3 * k}).matmul(edge_strengths(i).view({3 * k, k}));

    y = convolution(norm(y, prefix + "tcn.0", mode).relu(), prefix + "tcn.2", layer.stride);
    y = at::dropout(norm(y, prefix + "tcn.3", mode), settings_.dropout, mode == Mode::train);
    if (layer.residual == Residual::identity) y = y + x;
    if (layer.residual == Residual::convolution)
        y = y + norm(convolution(x, prefix + "residual.0", layer.stride), prefix + "residual.1", mode);
    return y.relu();
}

at::Tensor StgcnNet::fused_norm_of(const at::Tensor& x, const std::string& name, Mode mode, bool relu,
                                   double drop, std::uint64_t seed, const at::Tensor& shortcut) const {
    const NormWeights weights{weight(name + ".weight"), weight(name + ".bias"),
                              weight(name + ".running_mean"), weight(name + ".running_var")};
    return fused_norm(x, weights, {relu, mode == Mode::train ? drop : 0, seed}, shortcut,
                      mode == Mode::train);
}

at::Tensor StgcnNet::fused_convolution(const at::Tensor& x, const std::string& name,
                                       std::int64_t stride) const {
    const auto kernel = weight(name + ".weight").squeeze(3).permute({2, 1, 0}).contiguous();
    return fused_temporal_convolution(x, kernel, weight(name + ".bias"), stride);
}

/// The sums over source joints come before the 1x1 convolution: the same numbers, over fewer channels. The convolution's
/// bias then reaches a joint by the strengths of its edges.
at::Tensor StgcnNet::fused_graph(const at::Tensor& x, std::size_t i) const {
    const auto name = eval::layer_prefix(i) + "gcn.conv";
    const auto in = x.size(3), out = weight(name + ".bias").size(0) / 3;
    const auto strengths = edge_strengths(i);
    const auto kernel = weight(name + ".weight").view({3, out, in}).permute({0, 2, 1}).reshape({3 * in, out});
    const auto bias = strengths.sum(1).t().matmul(weight(name + ".bias").view({3, out}));
    return fused_graph_convolution(x, strengths.view(-1).index_select(0, edge_index_), kernel, bias, edges_);
}

at::Tensor StgcnNet::fused_layer(const at::Tensor& x, std::size_t i, Mode mode, std::uint64_t seed) const {
    const auto layer = eval::stgcn_layer(shape_, i);
    const auto prefix = eval::layer_prefix(i);
    at::Tensor shortcut;
    if (layer.residual == Residual::identity) shortcut = x;
    if (layer.residual == Residual::convolution)
        shortcut = fused_norm_of(fused_convolution(x, prefix + "residual.0", layer.stride),
                                 prefix + "residual.1", mode, false);
    auto y = fused_norm_of(fused_graph(x, i), prefix + "tcn.0", mode, true);
    y = fused_convolution(y, prefix + "tcn.2", layer.stride);
    return fused_norm_of(y, prefix + "tcn.3", mode, true, settings_.dropout, seed + i * golden_step,
                         shortcut);
}

at::Tensor StgcnNet::features(const at::Tensor& input, Mode mode, std::uint64_t dropout_seed) const {
    const auto n = input.size(0), c = input.size(1), t = input.size(2), k = input.size(3);
    if (takes_fused_path()) {
        auto x = fused_norm_of(input.permute({0, 2, 3, 1}).reshape({n, t, 1, k * c}), "data_bn", mode, false)
                     .view({n, t, k, c});
        for (std::size_t i = 0; i < eval::stgcn_layers; ++i) x = fused_layer(x, i, mode, dropout_seed);
        return x.mean({1, 2});
    }
    auto x = norm(input.permute({0, 3, 1, 2}).reshape({n, k * c, t}), "data_bn", mode).view({n, k, c, t});
    at::manual_seed(dropout_seed);
    x = x.permute({0, 2, 3, 1}).contiguous();
    for (std::size_t i = 0; i < eval::stgcn_layers; ++i) x = layer(x, i, mode);
    return x.mean({2, 3});
}

StgcnNet::Output StgcnNet::forward(const at::Tensor& x, Mode mode, std::uint64_t dropout_seed) const {
    if (x.size(1) != settings_.channels || x.size(3) != settings_.graph.joints())
        throw Error("the recogniser takes {} channels of {} joints, not {} of {}", settings_.channels,
                    settings_.graph.joints(), x.size(1), x.size(3));
    const auto found = features(x, mode, dropout_seed);
    return {at::linear(found, weight("fcn.weight").flatten(1), weight("fcn.bias")), found};
}

StgcnNet::Output StgcnNet::train_forward(const at::Tensor& x, std::uint64_t dropout_seed) {
    return forward(x, Mode::train, dropout_seed);
}

StgcnNet::Output StgcnNet::eval_forward(const at::Tensor& x) const {
    const at::NoGradGuard no_gradients;
    return forward(x, Mode::eval, 0);
}

std::vector<at::Tensor> StgcnNet::trained() const {
    std::vector<at::Tensor> parameters;
    for (const auto& info : declared_)
        if (info.trained) parameters.push_back(weight(info.name));
    return parameters;
}

std::vector<Array> StgcnNet::arrays() const {
    std::vector<Array> arrays;
    for (const auto& info : declared_) arrays.push_back(array_of(info.name, weight(info.name)));
    return arrays;
}

void StgcnNet::load(const std::vector<Array>& arrays, const std::string& where) {
    std::map<std::string, const Array*> by_name;
    for (const auto& array : arrays) by_name[array.name] = &array;
    for (const auto& info : declared_) {
        const auto found = by_name.find(info.name);
        if (found == by_name.end()) throw Error("{}: weight {} is missing", where, info.name);
        if (found->second->shape != info.shape)
            throw Error("{}: weight {} has shape ({}), not ({})", where, info.name,
                        fmt::join(found->second->shape, ", "), fmt::join(info.shape, ", "));
        copy_into(weight(info.name), *found->second, where);
    }
}

}  // namespace actformer::model
