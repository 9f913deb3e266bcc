// A network's weights in libtorch, spectral norms included. Includes torch headers: for model/'s own sources and tests only.
#pragma once

#include <ATen/ATen.h>
#include <torch/nn/module.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "model/nn/fused.hpp"
#include "model/nn/network.hpp"

namespace actformer::model {

/// Registers weights under their dotted names in a module: parameters() and buffers() hold them, and to(device) moves them.
/// A spectral weight comes with the buffers NAME_u and NAME_v, its singular vectors as known so far.
class WeightStore {
  public:
    /// Weights start at random from `seed`, alike on every device.
    WeightStore(torch::nn::Module& module, const std::vector<NetworkWeight>& weights, std::uint64_t seed,
                at::ScalarType type);

    const at::Tensor& at(const std::string& name) const { return entries_.at(name).weight; }

    /// The weight over its largest singular value; where it has none, the weight itself. With `iterate` one power iteration
    /// moves the singular vectors first, as in torch.nn.utils.spectral_norm; the gradient takes them for constants.
    at::Tensor normalised(const std::string& name, bool iterate) const;

    /// Whether processors take the path of our own; off, everything runs in libtorch's operators (as on a GPU).
    bool fused = true;

    /// The largest singular value as the vectors have it, without gradient.
    at::Tensor spectral_norm(const std::string& name) const;

    /// A layer's weight, normalised, and its bias.
    LinearTensors layer(const std::string& name, bool iterate) const {
        return {normalised(name + ".weight", iterate), at(name + ".bias")};
    }

    /// x (..., in) through such a layer -> (..., out), in libtorch's operators.
    at::Tensor linear(const at::Tensor& x, const std::string& name, bool iterate) const {
        const auto [weight, bias] = layer(name, iterate);
        return at::linear(x, weight, bias);
    }

  private:
    struct Entry {
        at::Tensor weight, u, v;
        std::int64_t rows = 0;
    };
    std::map<std::string, Entry> entries_;
};

}  // namespace actformer::model
