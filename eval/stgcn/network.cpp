#include "eval/stgcn/network.hpp"

#include <fmt/format.h>

#include <functional>
#include <numeric>

namespace actformer::eval {
namespace {

/// Collects tensors under their public names.
class TensorList {
  public:
    void norm(const std::string& name, std::uint64_t channels) {
        add(name + ".weight", {channels}, TensorRole::gain);
        add(name + ".bias", {channels}, TensorRole::offset);
        add(name + ".running_mean", {channels}, TensorRole::running_mean);
        add(name + ".running_var", {channels}, TensorRole::running_variance);
    }
    void convolution(const std::string& name, std::uint64_t out, std::uint64_t in, std::uint64_t taps) {
        add(name + ".weight", {out, in, taps, 1}, TensorRole::weight, in * taps);
        add(name + ".bias", {out}, TensorRole::bias, in * taps);
    }
    void add(std::string name, std::vector<std::uint64_t> shape, TensorRole role, std::uint64_t fan_in = 0) {
        list_.push_back({std::move(name), std::move(shape), role, fan_in});
    }
    std::vector<StgcnTensor> take() { return std::move(list_); }

  private:
    std::vector<StgcnTensor> list_;
};

}  // namespace

std::uint64_t StgcnTensor::count() const {
    return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
}

std::string layer_prefix(std::size_t layer) {
    return fmt::format("st_gcn_networks.{}.", layer);
}

StgcnLayer stgcn_layer(const StgcnShape& shape, std::size_t layer) {
    using Residual = StgcnLayer::Residual;
    const auto in = layer == 0 ? shape.channels : shape.widths[layer - 1];
    const auto out = shape.widths[layer], stride = stgcn_strides[layer];
    const auto residual = layer == 0                 ? Residual::none
                          : in == out && stride == 1 ? Residual::identity
                                                     : Residual::convolution;
    return {in, out, stride, residual};
}

std::vector<StgcnTensor> stgcn_tensors(const StgcnShape& shape) {
    const std::uint64_t joints = shape.joints();
    TensorList list;
    list.norm("data_bn", shape.channels * joints);
    for (std::size_t i = 0; i < stgcn_layers; ++i) {
        const auto layer = stgcn_layer(shape, i);
        const auto prefix = layer_prefix(i);
        list.convolution(prefix + "gcn.conv", 3 * std::uint64_t{layer.out}, layer.in, 1);
        list.norm(prefix + "tcn.0", layer.out);
        list.convolution(prefix + "tcn.2", layer.out, layer.out, stgcn_taps);
        list.norm(prefix + "tcn.3", layer.out);
        if (layer.residual == StgcnLayer::Residual::convolution) {
            list.convolution(prefix + "residual.0", layer.out, layer.in, 1);
            list.norm(prefix + "residual.1", layer.out);
        }
        list.add(fmt::format("edge_importance.{}", i), {3, joints, joints}, TensorRole::importance);
    }
    list.convolution("fcn", shape.classes, shape.features(), 1);
    return list.take();
}

}  // namespace actformer::eval
