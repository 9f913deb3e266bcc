// CSGN's generator. Includes torch headers: for model/'s own sources and tests only.
#pragma once

#include <vector>

#include "model/generators/adversarial/networks.hpp"
#include "model/generators/csgn/layers.hpp"
#include "model/generators/graph/node_convolution.hpp"
#include "model/nn/weight_store.hpp"

namespace actformer::model {

class CsgnGenerator : public GanGenerator {
  public:
    /// Weights start at random from `seed`, alike on every device; to(device) moves them. `type` is at::kFloat, or
    /// at::kDouble for checks. Throws Error for settings of no network.
    CsgnGenerator(CsgnSettings settings, std::uint64_t seed, at::ScalarType type = at::kFloat);

    const PriorSettings& prior() const override { return prior_; }
    std::int64_t latent_frames(std::int64_t frames) const override;

    /// latent (N, 1, latent_frames(frames), channels), labels (N) int64 -> motions (N, P*D, frames, K). Throws Error for others. In
    /// training mode batch norms take the batch's statistics and move the running ones, else they take the running ones.
    at::Tensor generate(const at::Tensor& latent, const at::Tensor& labels, std::int64_t frames) override;

    /// Running statistics of the EMA's own weights: means over batches of motions.
    void recompute_buffers(const Prior& prior, const at::Tensor& labels, std::int64_t frames) override;

    const CsgnSettings& settings() const { return settings_; }

    /// Whether processors take the path of our own (the default), or libtorch's operators as on a GPU.
    void set_fused(bool fused) { weights_.fused = fused; }

  private:
    bool takes_fused_path(const at::Tensor& latent) const { return weights_.fused && latent.is_cpu(); }
    at::Tensor level(const at::Tensor& x, const at::Tensor& labels, std::size_t i, bool fused) const;
    at::Tensor motions(const at::Tensor& x, std::int64_t frames, bool fused) const;

    CsgnSettings settings_;
    PriorSettings prior_;
    GeneratorLayers layers_;
    WeightStore weights_;
    std::vector<GraphSums> sums_;  ///< of the levels and of the last layer
    double momentum_ = 0.1;        ///< of the running statistics
};

}  // namespace actformer::model
