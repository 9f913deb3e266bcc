// ACTOR's encoder and decoder (Petrovich et al., ICCV 2021, section 3). Includes torch headers: for model/'s own sources and tests only.
//
// Layers are normalised behind their sums, as in "Attention is all you need" (Vaswani et al. 2017); the decoder attends to a single token.
#pragma once

#include <torch/nn/module.h>

#include "model/cpu/random_kernel.hpp"
#include "model/generators/actor/settings.hpp"
#include "model/nn/weight_store.hpp"

namespace actformer::model {

/// What a training step drops; a rate of 0 drops nothing. Samples are counted over all processes' batches.
struct ActorDropout {
    double rate = 0;
    std::uint64_t seed = 0, step = 0, first_sample = 0;

    /// Of the layer's place `site`, below 2048.
    cpu::Dropout at(std::uint64_t site) const;
};

class ActorNet : public torch::nn::Module {
  public:
    /// Weights start at random from `seed`, alike on every device; to(device) moves them. `type` is at::kFloat, or
    /// at::kDouble for checks. Throws Error for settings of no network.
    ActorNet(const ActorSettings& settings, std::uint64_t seed, at::ScalarType type = at::kFloat);

    /// Of the latent vectors' normal distributions, (N, W) each.
    struct Latent {
        at::Tensor mean, log_variance;
    };

    /// motion (N, P*D, T, K), labels (N) int64.
    Latent encode(const at::Tensor& motion, const at::Tensor& labels, const ActorDropout& dropout = {}) const;

    /// latent (N, W), labels (N) int64 -> motion (N, P*D, T, K), not finished.
    at::Tensor decode(const at::Tensor& latent, const at::Tensor& labels, std::int64_t frames,
                      const ActorDropout& dropout = {}) const;

    const ActorSettings& settings() const { return settings_; }

    /// Whether processors take the path of our own (the default), or libtorch's operators as on a GPU.
    void set_fused(bool fused) { weights_.fused = fused; }

  private:
    bool takes_fused_path(const at::Tensor& x) const { return weights_.fused && x.is_cpu(); }
    LinearTensors linear(const std::string& name) const;
    LinearTensors projections(const std::string& name, std::int64_t first, std::int64_t count) const;
    at::Tensor norm(const at::Tensor& x, const std::string& name) const;
    at::Tensor attention(const at::Tensor& queries, const at::Tensor& tokens, const std::string& name,
                         const cpu::Dropout& dropout) const;
    at::Tensor attended(const at::Tensor& queries, const at::Tensor& tokens, const std::string& layer,
                        std::uint64_t site, const ActorDropout& dropout) const;
    at::Tensor mapped(const at::Tensor& x, const std::string& layer, const char* norm, std::uint64_t site,
                      const ActorDropout& dropout) const;
    at::Tensor seen_of(const at::Tensor& memory, const std::string& name, bool by_head) const;
    at::Tensor crossed(const at::Tensor& x, const at::Tensor& memory, const std::string& layer,
                       std::uint64_t site, const ActorDropout& dropout) const;
    at::Tensor fused_attended(const at::Tensor& x, const std::string& layer, std::uint64_t site,
                              const ActorDropout& dropout) const;
    at::Tensor fused_mapped(const at::Tensor& x, const std::string& layer, const char* norm,
                            std::uint64_t site, const ActorDropout& dropout) const;
    at::Tensor fused_crossed(const at::Tensor& x, const at::Tensor& memory, const std::string& layer,
                             std::uint64_t site, const ActorDropout& dropout) const;

    ActorSettings settings_;
    WeightStore weights_;
};

}  // namespace actformer::model
