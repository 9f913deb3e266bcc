// ActFormer's discriminator (Xu, Song et al., ICCV 2023). Includes torch headers: for model/'s own sources and tests only.
#pragma once

#include "model/generators/actformer/layers.hpp"
#include "model/generators/adversarial/networks.hpp"
#include "model/generators/joint_positions.hpp"
#include "model/nn/weight_store.hpp"

namespace actformer::model {

class ActFormerDiscriminator : public GanDiscriminator {
  public:
    /// Weights start at random from `seed`, alike on every device; to(device) moves them. `type` is at::kFloat, or
    /// at::kDouble for checks. Throws Error for settings of no network.
    ActFormerDiscriminator(ActFormerDiscriminatorSettings settings, std::uint64_t seed,
                           at::ScalarType type = at::kFloat);

    /// motion (N, P*D, T, K), labels (N) int64 -> scores (N), the higher the more real. At least fewest_frames frames; throws
    /// Error below. In training mode one power iteration moves every spectral norm: give real and generated motions together.
    at::Tensor forward(const at::Tensor& motion, const at::Tensor& labels) override;

    const ActFormerDiscriminatorSettings& settings() const { return settings_; }
    const WeightStore& weights() const { return weights_; }

    /// Whether processors take the path of our own (the default), or libtorch's operators as on a GPU.
    void set_fused(bool fused) { weights_.fused = fused; }

  private:
    bool takes_fused_path(const at::Tensor& motion) const { return weights_.fused && motion.is_cpu(); }
    at::Tensor seen(const at::Tensor& motion) const;
    at::Tensor convolved(const at::Tensor& x, std::size_t i) const;
    at::Tensor features(const at::Tensor& motion) const;
    at::Tensor fused_features(const at::Tensor& motion) const;
    at::Tensor node_bias(std::size_t i) const;
    at::Tensor pooled(const at::Tensor& features) const;

    ActFormerDiscriminatorSettings settings_;
    std::optional<JointPositions> joints_;  ///< where it sees their velocities
    WeightStore weights_;
    std::vector<NodeConvolution> convolutions_;
    std::vector<at::Tensor> sums_;  ///< (hops, out, in) of every convolution
    std::vector<std::shared_ptr<const cpu::NodeSums>>
        node_sums_;  ///< the same for processors, and the last convolution's
};

}  // namespace actformer::model
