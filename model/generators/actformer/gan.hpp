// The two networks at their game (DESIGN 4.7): steps, and all that must be kept to go on with it exactly. Knows nothing of
// files. Includes torch headers.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "model/generators/actformer/discriminator.hpp"
#include "model/generators/actformer/gan_settings.hpp"
#include "model/generators/actformer/generator.hpp"
#include "model/generators/actformer/prior.hpp"
#include "model/nn/adam.hpp"
#include "model/nn/array.hpp"
#include "model/train/processes.hpp"

namespace actformer::model {

/// Every parameter and buffer of a network, under `prefix` and its name; and back, throwing Error that begins with `where`
/// for what is missing or of another shape.
std::vector<Array> arrays_of(const torch::nn::Module& module, const std::string& prefix);
void load_arrays(const torch::nn::Module& module, const std::string& prefix, const std::vector<Array>& arrays,
                 const std::string& where);

class Gan {
  public:
    /// `processes` must outlive the game. Every process begins with the weights of rank 0.
    Gan(const GanSettings& settings, const GeneratorSettings& generator,
        const DiscriminatorSettings& discriminator, const at::Device& device, const Processes& processes);

    /// One step of the discriminator: real (batch, P*D, T, K) against as many generated motions of the same labels (batch)
    /// int64. What is drawn is a function of the seed and `draw`.
    void step_discriminator(const at::Tensor& real, const at::Tensor& labels, std::uint64_t draw);
    void step_generator(const at::Tensor& labels, std::uint64_t draw);

    /// Steps from now on go at this share of the rates.
    void set_rate_share(double share) { rate_share_ = share; }

    /// Summed over the steps since reset(): [discriminator's loss, its score of real and of generated motions, generator's
    /// loss], (4) double on the device, means over the processes.
    at::Tensor& sums() { return sums_; }

    /// The generator whose motions are shown: with the mean weights where a mean is kept.
    Generator& shown();
    Generator& generator() { return *generator_; }

    bool finite();  ///< every weight of both networks

    /// All that a step depends on, its number, `draw` and the windows apart; `steps` counts the generator's.
    std::vector<Array> arrays();
    void load(const std::vector<Array>& arrays, std::uint64_t steps, const std::string& where);

    /// Gives every process the state of rank 0, after `steps` steps of the generator.
    void share(std::uint64_t steps);

  private:
    void count(std::uint64_t steps);
    at::Tensor latent(const at::Tensor& labels, std::uint64_t draw);
    std::vector<at::Tensor> state();

    GanSettings settings_;
    at::Device device_;
    const Processes& processes_;
    Prior prior_;
    std::shared_ptr<Generator> generator_, shown_;
    std::shared_ptr<Discriminator> discriminator_;
    FlatParameters generator_parameters_, discriminator_parameters_;
    std::optional<FlatParameters> shown_parameters_;  ///< where a mean is kept
    Adam generator_adam_, discriminator_adam_;
    double rate_share_ = 1;
    at::Tensor sums_;
};

}  // namespace actformer::model
