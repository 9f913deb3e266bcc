// A generator and a discriminator that train against each other: their steps, and the state that a checkpoint holds. Knows
// nothing of files. Includes torch headers.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "model/generators/adversarial/gan_settings.hpp"
#include "model/generators/adversarial/networks.hpp"
#include "model/generators/adversarial/prior.hpp"
#include "model/nn/adam.hpp"
#include "model/nn/array.hpp"
#include "model/nn/cuda_graph.hpp"
#include "model/train/augmentation.hpp"
#include "model/train/processes.hpp"

namespace actformer::model {

class Gan {
  public:
    /// Networks on `device`. `processes` must outlive it. Every process begins with the weights of rank 0. The discriminator sees real
    /// and fake motions through `augmentation`.
    Gan(const GanSettings& settings, GanNetworks networks, const at::Device& device,
        const Processes& processes, Augmentation augmentation = {});

    /// One step of the discriminator: real (batch, P*D, T, K) against as many fake motions of the same labels (batch) int64; on a GPU a batch
    /// is as large in every step. What is drawn is a function of the seed and `draw`.
    void step_discriminator(const at::Tensor& real, const at::Tensor& labels, std::uint64_t draw);
    /// One step of the generator, for as many motions of these labels; `real` are motions of them.
    void step_generator(const at::Tensor& real, const at::Tensor& labels, std::uint64_t draw);

    /// Steps from now on go at this share of the rates.
    void set_rate_share(double share) { rate_share_ = share; }

    /// Added to by every step: [discriminator's loss, its scores of real and of fake motions, generator's loss], (4) double
    /// on the device, means over the processes.
    at::Tensor& sums() { return sums_; }

    GanGenerator& generator() { return *networks_.generator; }

    /// The generator with the EMA of its weights, its buffers those of motions of `labels` (N) int64; the generator itself where no
    /// EMA is kept.
    GanGenerator& ema(const at::Tensor& labels);

    bool finite();  ///< every weight of both networks

    /// All that a step depends on, its number, `draw` and the windows apart; `steps` counts the generator's.
    std::vector<Array> state();
    void load(const std::vector<Array>& arrays, std::uint64_t steps, const std::string& where);

    /// Gives every process the state of rank 0, after `steps` steps of the generator.
    void broadcast(std::uint64_t steps);

  private:
    void count(std::uint64_t steps);
    /// What forward and backward passes of a step read.
    struct Inputs {
        at::Tensor real, labels, latent;
    };

    Inputs inputs(const at::Tensor& real, const at::Tensor& labels, std::uint64_t draw);
    void discriminator_gradients(const Inputs& in, std::uint64_t draw);
    void generator_gradients(const Inputs& in, std::uint64_t draw);
    at::Tensor fake(const Inputs& in);
    at::Tensor latent(const at::Tensor& labels, std::uint64_t draw);
    std::vector<at::Tensor> optimiser_state();
    at::Tensor augmented(const at::Tensor& motion, std::uint64_t draw) const;

    GanSettings settings_;
    at::Device device_;
    const Processes& processes_;
    GanNetworks networks_;
    Prior prior_;
    Augmentation augmentation_;
    FlatParameters generator_parameters_, discriminator_parameters_;
    std::optional<FlatParameters> ema_parameters_;  ///< where an EMA is kept
    Adam generator_adam_, discriminator_adam_;
    CudaGraph discriminator_graph_, generator_graph_;  ///< of forward and backward passes
    Inputs static_inputs_;                             ///< on GPUs, where graphs read them
    double rate_share_ = 1;
    at::Tensor sums_;
};

}  // namespace actformer::model
