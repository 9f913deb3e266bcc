// Action2Motion: a variational autoencoder that goes frame by frame, its prior learnt (Guo et al., ACM Multimedia 2020). Includes torch
// headers: for model/'s own sources and tests only.
//
// Three networks of GRU cells. In frame t, `seen` being the last pose, c the class and the share of the motion that has passed:
// prior(seen, c) and posterior(pose, c) give the latent's distribution, decoder(seen, c, latent) the pose.
#pragma once

#include <torch/nn/module.h>

#include <optional>
#include <utility>

#include "model/generators/action2motion/chains.hpp"
#include "model/generators/action2motion/settings.hpp"
#include "model/nn/fused_gru.hpp"
#include "model/nn/weight_store.hpp"

namespace actformer::model::action2motion {

/// Of normal numbers, (T, N, latent) each.
struct Distribution {
    at::Tensor mean, log_variance;
};

/// What the networks make of real motions.
struct Outcome {
    at::Tensor out;    ///< (T, N, D) the decoder's: poses, or with a Lie body the root and rotations
    at::Tensor poses;  ///< (T, N, D) that the loss compares
    Distribution posterior, prior;
    at::Tensor reconstruction;  ///< (T) mean squared errors
    at::Tensor
        divergence;  ///< (T) Kullback and Leibler's, of posterior from prior: means over motions, sums over the latent
};

class Network : public torch::nn::Module {
  public:
    /// Weights start at random from `seed`. `type` is at::kFloat, or at::kDouble for checks.
    Network(Settings settings, std::uint64_t seed, at::ScalarType type = at::kFloat);

    /// Real poses (T, N, D), labels (N) int64, noise (T, N, latent) of the posterior. Frames are fed the decoder's `own` outputs, or
    /// else the real poses.
    Outcome forward(const at::Tensor& real, const at::Tensor& labels, const at::Tensor& noise,
                    bool own) const;

    /// Poses (T, N, D) of labels (N), noise (T, N, latent) of the prior; bones (N, joints) of a Lie body, else not looked at. A
    /// motion of fewer frames than the settings' is the beginning of one.
    at::Tensor generate(const at::Tensor& labels, const at::Tensor& noise, const at::Tensor& bones) const;

    const Settings& settings() const { return settings_; }

    /// Whether processors take the path of our own (the default), or libtorch's operators as on a GPU.
    void set_fused(bool fused) { weights_.fused = fused; }

  private:
    class Stack;
    class Gates;

    Outcome frame_by_frame(const at::Tensor& real, const at::Tensor& labels, const at::Tensor& noise,
                           bool own) const;
    Outcome all_at_once(const at::Tensor& real, const at::Tensor& labels, const at::Tensor& noise,
                        bool own) const;
    at::Tensor generate_at_once(const at::Tensor& labels, const at::Tensor& noise,
                                const at::Tensor& bones) const;
    at::Tensor generate_frame_by_frame(const at::Tensor& labels, const at::Tensor& noise,
                                       const at::Tensor& bones) const;
    ChainBodyTensors chain_body(const at::Tensor& bones) const;
    std::vector<GruTensors> cells(const std::string& network, int count) const;
    Distribution distribution_of_all(const std::string& network, const at::Tensor& poses,
                                     const at::Tensor& labels) const;
    std::pair<at::Tensor, at::Tensor> decoded(const at::Tensor& real, const at::Tensor& seen,
                                              const at::Tensor& labels, const at::Tensor& latents,
                                              bool own) const;
    at::Tensor linear(const std::string& name, const at::Tensor& x) const;
    at::Tensor condition(const at::Tensor& labels, std::int64_t frame) const;
    at::Tensor headed(const at::Tensor& state) const;
    Distribution distribution(const std::string& network, const at::Tensor& state) const;

    Settings settings_;
    std::optional<Chains> chains_;  ///< of a Lie body
    WeightStore weights_;
};

}  // namespace actformer::model::action2motion
