// CSGN's discriminator. Includes torch headers: for model/'s own sources and tests only.
#pragma once

#include <vector>

#include "model/generators/adversarial/networks.hpp"
#include "model/generators/csgn/layers.hpp"
#include "model/generators/graph/node_convolution.hpp"
#include "model/nn/weight_store.hpp"

namespace actformer::model {

class CsgnDiscriminator : public GanDiscriminator {
  public:
    /// Weights start at random from `seed`, alike on every device; to(device) moves them. `type` is at::kFloat, or
    /// at::kDouble for checks. Throws Error for settings of no network.
    CsgnDiscriminator(CsgnSettings settings, std::uint64_t seed, at::ScalarType type = at::kFloat);

    /// motion (N, P*D, T, K), labels (N) int64 -> scores (N), the higher the more real. At least csgn_fewest_frames frames;
    /// throws Error below. In training mode one power iteration moves every spectral norm.
    at::Tensor forward(const at::Tensor& motion, const at::Tensor& labels) override;

    const CsgnSettings& settings() const { return settings_; }

    /// Whether processors take the path of our own (the default), or libtorch's operators as on a GPU.
    void set_fused(bool fused) { weights_.fused = fused; }

  private:
    at::Tensor features(const at::Tensor& motion) const;

    CsgnSettings settings_;
    DiscriminatorLayers layers_;
    WeightStore weights_;
    std::vector<GraphSums> sums_;  ///< of the levels and of the last layer
};

}  // namespace actformer::model
