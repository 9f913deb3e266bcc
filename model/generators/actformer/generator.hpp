// ActFormer's generator (Xu, Song et al., ICCV 2023). Includes torch headers: for model/'s own sources and tests only.
#pragma once

#include "model/generators/actformer/layers.hpp"
#include "model/generators/adversarial/networks.hpp"
#include "model/nn/weight_store.hpp"

namespace actformer::model {

class ActFormerGenerator : public GanGenerator {
  public:
    /// Weights start at random from `seed`, alike on every device; to(device) moves them. `type` is at::kFloat, or
    /// at::kDouble for checks. Throws Error for settings of no network.
    ActFormerGenerator(ActFormerGeneratorSettings settings, std::uint64_t seed,
                       at::ScalarType type = at::kFloat);

    /// latent (N, streams, T, channels) of Prior::draw, labels (N) int64 -> motion (N, P*D, T, K), person by person. T up to
    /// settings().frames; Throws Error beyond. In training mode one power iteration moves every spectral norm.
    at::Tensor forward(const at::Tensor& latent, const at::Tensor& labels);

    const PriorSettings& prior() const override { return settings_.prior; }
    at::Tensor generate(const at::Tensor& latent, const at::Tensor& labels,
                        std::int64_t /*frames*/) override {
        return forward(latent, labels);
    }
    void recompute_buffers(const Prior& prior, const at::Tensor& labels, std::int64_t frames) override;

    const ActFormerGeneratorSettings& settings() const { return settings_; }
    const WeightStore& weights() const { return weights_; }

    /// Whether processors take the path of our own (the default), or libtorch's operators as on a GPU.
    void set_fused(bool fused) { weights_.fused = fused; }

  private:
    bool takes_fused_path(const at::Tensor& latent) const { return weights_.fused && latent.is_cpu(); }
    at::Tensor linear(const at::Tensor& x, const std::string& name) const {
        return weights_.linear(x, name, is_training());
    }
    at::Tensor per_token(const at::Tensor& latent) const;
    at::Tensor tokens(const at::Tensor& latent, const at::Tensor& labels) const;
    at::Tensor transformed(at::Tensor x) const;
    at::Tensor fused_tokens(const at::Tensor& latent, const at::Tensor& labels) const;
    at::Tensor fused_transformed(at::Tensor x) const;
    at::Tensor smoothed(const at::Tensor& x) const;
    at::Tensor motion(const at::Tensor& x) const;
    at::Tensor with_smooth_root(const at::Tensor& motion) const;
    at::Tensor positions() const;
    at::Tensor block(const at::Tensor& x, const std::string& prefix) const;
    at::Tensor poses(const at::Tensor& x) const;
    at::Tensor graph_layer(const at::Tensor& x, const std::string& name, const at::Tensor& sums) const;

    ActFormerGeneratorSettings settings_;
    WeightStore weights_;
    at::Tensor to_middle_, to_fine_, within_fine_;  ///< (hops, out, in) of a graphconv body
};

}  // namespace actformer::model
