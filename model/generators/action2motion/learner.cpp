#include "model/generators/action2motion/learner.hpp"

#include <ATen/Parallel.h>

#include <utility>

#include "model/cpu/random_kernel.hpp"
#include "model/train/window_tensors.hpp"

namespace actformer::model::action2motion {
namespace {

/// Random numbers of a seed and a step have nothing to do with each other where their purposes differ.
constexpr std::uint8_t for_noise = 1, for_feeding = 2;

constexpr std::int64_t losses_told = 2;  // reconstruction, divergence

std::shared_ptr<Network> network_of(const Settings& settings, const at::Device& device) {
    auto network = std::make_shared<Network>(settings, settings.seed);
    network->to(device);
    return network;
}

/// Every process takes its own part of the windows.
kernels::SamplerOptions sampling(const Settings& settings, std::uint64_t first) {
    return {settings.seed, kernels::ClassSampling::square_root, true, static_cast<std::uint32_t>(first),
            settings.padding};
}

/// Whether a step is fed its own outputs: for all processes alike.
bool feeds_own(const Settings& settings, std::uint64_t step) {
    const auto word = cpu::random_words({settings.seed, step, for_feeding}, 0, 0)[0];
    return word * 0x1p-32 < settings.tf_ratio;
}

}  // namespace

MotionLearner::MotionLearner(const Config& config, const Settings& settings, const std::string& where,
                             const LearnerSetup& setup)
    : MotionLearner(network_of(settings, setup.device),
                    static_cast<std::uint32_t>(config.get<std::int64_t>("batch")), where, setup) {}

MotionLearner::MotionLearner(std::shared_ptr<Network> network, std::uint32_t batch, const std::string& where,
                             const LearnerSetup& setup)
    : NetworkLearner(
          network, network->settings().average > 0 ? network_of(network->settings(), setup.device) : nullptr,
          network->settings().adam(), network->settings().average, losses_told, setup),
      network_(std::move(network)),
      batch_(batch),
      motions_(network_->settings(), where),
      feed_(setup.clips,
            sampling(network_->settings(), static_cast<std::uint64_t>(setup.processes.place().rank) * batch),
            batch, network_->settings().frames) {}

/// Of the posterior, (T, N, latent).
at::Tensor MotionLearner::noise(std::uint64_t step) const {
    const auto& settings = network_->settings();
    const std::int64_t n = batch_, t = settings.frames, latent = settings.latent;
    auto normals = at::empty({n, t, latent}, at::kFloat);
    cpu::normal_numbers({settings.seed, step, for_noise},
                        static_cast<std::uint64_t>(setup().processes.place().rank) * batch_, n, t * latent,
                        normals.data_ptr<float>(), at::get_num_threads());
    return normals.transpose(0, 1).contiguous().to(setup().device);
}

void MotionLearner::step(std::uint64_t step, double rate_share) {
    const auto& settings = network_->settings();
    const auto windows = feed_.batch(step);
    const auto labels = labels_of(windows, setup().device);
    const auto real = motions_.poses(
        values_of(windows, settings.channels(), settings.frames, settings.nodes(), setup().device));
    parameters().zero_gradients();
    const auto outcome = network_->forward(real, labels, noise(step), feeds_own(settings, step));
    const auto reconstruction = outcome.reconstruction.sum(), divergence = outcome.divergence.sum();
    (reconstruction + settings.lambda_kl * divergence).backward();
    all_reduce_mean(at::stack({reconstruction, divergence}));
    if (settings.weight_decay > 0)
        parameters().gradients().add_(parameters().values(), settings.weight_decay);
    move(rate_share);
}

Measures MotionLearner::losses(const std::vector<double>& sums, std::uint64_t steps) const {
    const auto n = static_cast<double>(steps);
    return {{"loss", "loss", (sums[0] + network_->settings().lambda_kl * sums[1]) / n},
            {"reconstruction", "reconstruction", sums[0] / n},
            {"kl", "KL", sums[1] / n}};
}

}  // namespace actformer::model::action2motion
