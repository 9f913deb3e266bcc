#include "model/generators/action2motion/learner.hpp"

#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>
#include <fmt/format.h>

#include "model/cpu/random_kernel.hpp"
#include "model/nn/module_arrays.hpp"
#include "model/nn/tensor_array.hpp"
#include "model/train/training.hpp"

namespace actformer::model::action2motion {
namespace {

/// Random numbers of a seed and a step have nothing to do with each other where their purposes differ.
constexpr std::uint8_t for_noise = 1, for_feeding = 2;

/// Every process takes its own part of the windows.
kernels::SamplerOptions sampling(std::uint64_t seed, std::uint64_t first) {
    return {seed, kernels::ClassSampling::square_root, true, static_cast<std::uint32_t>(first)};
}

/// Whether a step is fed its own outputs: for all processes alike.
bool feeds_own(const Settings& settings, std::uint64_t step) {
    const auto word = cpu::random_words({settings.seed, step, for_feeding}, 0, 0)[0];
    return word * 0x1p-32 < settings.tf_ratio;
}

}  // namespace

MotionLearner::MotionLearner(const Config& config, const Settings& settings, const std::string& where,
                             const LearnerSetup& setup)
    : settings_(settings),
      batch_(static_cast<std::uint32_t>(config.get<std::int64_t>("batch"))),
      setup_(setup),
      motions_(settings, where),
      feed_(setup.clips,
            sampling(settings.seed, static_cast<std::uint64_t>(setup.processes.place().rank) * batch_),
            batch_, settings.frames),
      network_(settings, settings.seed),
      parameters_((network_.to(setup.device), network_.parameters()), 2),
      adam_(parameters_, settings.adam()),
      sums_(at::zeros({2}, at::TensorOptions(at::kDouble).device(setup.device))) {
    if (settings.average > 0) {
        ema_ = std::make_unique<Network>(settings, settings.seed);
        ema_->to(setup.device);
        ema_parameters_.emplace(ema_->parameters());
    }
    share(0);
}

/// Of the posterior, (T, N, latent).
at::Tensor MotionLearner::noise(std::uint64_t step) const {
    const std::int64_t n = batch_, t = settings_.frames, latent = settings_.latent;
    auto normals = at::empty({n, t, latent}, at::kFloat);
    cpu::normal_numbers({settings_.seed, step, for_noise},
                        static_cast<std::uint64_t>(setup_.processes.place().rank) * batch_, n, t * latent,
                        normals.data_ptr<float>(), at::get_num_threads());
    return normals.transpose(0, 1).contiguous().to(setup_.device);
}

void MotionLearner::step(std::uint64_t step, double rate_share) {
    const auto windows = feed_.batch(step);
    const auto labels = labels_of(windows, setup_.device);
    const auto real = motions_.poses(
        values_of(windows, settings_.channels(), settings_.frames, settings_.nodes(), setup_.device));
    parameters_.zero_gradients();
    const auto outcome = network_.forward(real, labels, noise(step), feeds_own(settings_, step));
    const auto reconstruction = outcome.reconstruction.sum(), divergence = outcome.divergence.sum();
    (reconstruction + settings_.lambda_kl * divergence).backward();
    parameters_.remarks().copy_(at::stack({reconstruction.detach(), divergence.detach()}));
    setup_.processes.average(parameters_.message());
    if (settings_.weight_decay > 0)
        parameters_.gradients().add_(parameters_.values(), settings_.weight_decay);
    adam_.step(rate_share);
    sums_.add_(parameters_.remarks());
    if (ema_) ema_parameters_->follow(parameters_, settings_.average, adam_.steps);
}

Measures MotionLearner::losses(const std::vector<double>& sums, std::uint64_t steps) const {
    const auto n = static_cast<double>(steps);
    return {{"loss", "loss", (sums[0] + settings_.lambda_kl * sums[1]) / n},
            {"reconstruction", "reconstruction", sums[0] / n},
            {"kl", "KL", sums[1] / n}};
}

bool MotionLearner::finite() {
    return at::isfinite(parameters_.values()).all().item<bool>();
}

/// What is not a weight of the network, but belongs to the state.
std::vector<at::Tensor> MotionLearner::optimiser_state() {
    std::vector<at::Tensor> all{adam_.squares()};
    if (adam_.means().defined()) all.push_back(adam_.means());
    if (ema_) all.push_back(ema_parameters_->values());
    return all;
}

std::vector<Array> MotionLearner::state() {
    auto all = arrays_of(network_, "network.");
    std::size_t i = 0;
    for (const auto& tensor : optimiser_state())
        all.push_back(array_of(fmt::format("state.{}", i++), tensor));
    return all;
}

void MotionLearner::load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) {
    load_arrays(network_, "network.", state, where);
    std::size_t i = 0;
    for (const auto& tensor : optimiser_state())
        copy_into(tensor, array_named(state, fmt::format("state.{}", i++), where), where);
    adam_.steps = steps;
}

void MotionLearner::share(std::uint64_t steps) {
    const at::NoGradGuard no_gradients;
    setup_.processes.share(parameters_.values());
    for (auto& tensor : optimiser_state()) setup_.processes.share(tensor);
    adam_.steps = steps;
}

std::vector<Array> MotionLearner::weights() {
    return arrays_of(network_, "");
}

std::vector<Array> MotionLearner::ema_weights() {
    return ema_ ? arrays_of(*ema_, "") : weights();
}

}  // namespace actformer::model::action2motion
