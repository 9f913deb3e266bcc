// The ST-GCN recogniser in libtorch. Includes torch headers: for model/'s own sources and tests only.
#pragma once

#include <ATen/ATen.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "model/nn/array.hpp"
#include "model/recognisers/stgcn.hpp"

namespace actformer::model {

class StgcnNet {
  public:
    /// Weights start at random from `seed`, alike on every device. `type` is at::kFloat or at::kDouble.
    StgcnNet(StgcnSettings settings, std::uint64_t seed, const at::Device& device = at::kCPU,
             at::ScalarType type = at::kFloat);

    struct Output {
        at::Tensor logits;    ///< (N, classes)
        at::Tensor features;  ///< (N, width of the last layer): 256 for the public network
    };

    /// x (N, channels, T, K). Takes the statistics of the batch, updates the running ones and drops out at random:
    /// what is dropped is a function of `dropout_seed` alone.
    Output train_forward(const at::Tensor& x, std::uint64_t dropout_seed);

    /// The same with the running statistics and without dropout or gradients.
    Output eval_forward(const at::Tensor& x) const;

    const StgcnSettings& settings() const { return settings_; }
    const std::vector<NetworkWeight>& declared() const { return declared_; }
    at::Tensor& weight(const std::string& name) { return weights_.at(name); }
    const at::Tensor& weight(const std::string& name) const { return weights_.at(name); }

    /// What gradients move, sharing memory with the weights, in the order of declared().
    std::vector<at::Tensor> trained() const;

    /// Every weight, in the order of declared().
    std::vector<Array> arrays() const;

    /// Throws Error, beginning with `where`, for a weight that is missing or of another shape.
    void load(const std::vector<Array>& arrays, const std::string& where);

    /// Whether the CPU path of our own is taken; off, everything runs in libtorch's operators (as on a GPU).
    bool fused = true;

  private:
    enum class Mode { train, eval };
    bool takes_fused_path() const { return fused && partition_.is_cpu(); }
    at::Tensor features(const at::Tensor& x, Mode mode, std::uint64_t dropout_seed) const;
    Output forward(const at::Tensor& x, Mode mode, std::uint64_t dropout_seed) const;
    at::Tensor edge_strengths(std::size_t layer) const;

    // In libtorch's operators, (N, C, T, K).
    at::Tensor norm(const at::Tensor& x, const std::string& name, Mode mode) const;
    at::Tensor convolution(const at::Tensor& x, const std::string& name, std::int64_t stride) const;
    at::Tensor layer(const at::Tensor& x, std::size_t i, Mode mode) const;

    // In our own, (N, T, K, C).
    at::Tensor fused_norm_of(const at::Tensor& x, const std::string& name, Mode mode, bool relu,
                             double drop = 0, std::uint64_t seed = 0, const at::Tensor& shortcut = {}) const;
    at::Tensor fused_convolution(const at::Tensor& x, const std::string& name, std::int64_t stride) const;
    at::Tensor fused_graph(const at::Tensor& x, std::size_t i) const;
    at::Tensor fused_layer(const at::Tensor& x, std::size_t i, Mode mode, std::uint64_t seed) const;

    StgcnSettings settings_;
    eval::StgcnShape shape_;
    std::vector<NetworkWeight> declared_;
    std::map<std::string, at::Tensor> weights_;
    at::Tensor partition_;   ///< (3, K, K)
    at::Tensor edges_;       ///< (E, 3) int32: where the partition is not zero, as cpu::Edge
    at::Tensor edge_index_;  ///< (E) the same as places in the partition
};

}  // namespace actformer::model
