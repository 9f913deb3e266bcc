#include "model/generators/actor/learner.hpp"

#include <ATen/Parallel.h>

#include <utility>

#include "model/train/window_tensors.hpp"

namespace actformer::model {
namespace {

constexpr std::uint8_t for_noise = 1;    // of cpu::RandomPlace
constexpr std::int64_t losses_told = 4;  // loss, rc, rcxyz, kl

std::shared_ptr<ActorNet> network_of(const ActorSettings& settings, std::uint64_t seed,
                                     const at::Device& device) {
    auto network = std::make_shared<ActorNet>(settings, seed);
    network->to(device);
    return network;
}

kernels::SamplerOptions sampling(const ActorTraining& training, std::uint64_t first_sample) {
    return {training.seed, kernels::ClassSampling::square_root, true,
            static_cast<std::uint32_t>(first_sample), training.padding};
}

}  // namespace

ActorLearner::ActorLearner(const ActorSettings& settings, const ActorTraining& training,
                           const MotionSpec& spec, const LearnerSetup& setup)
    : ActorLearner(network_of(settings, training.seed, setup.device), training, spec, setup) {}

ActorLearner::ActorLearner(std::shared_ptr<ActorNet> network, const ActorTraining& training,
                           const MotionSpec& spec, const LearnerSetup& setup)
    : NetworkLearner(
          network,
          training.average > 0 ? network_of(network->settings(), training.seed, setup.device) : nullptr,
          training.adam(), training.average, losses_told, setup),
      training_(training),
      first_sample_(static_cast<std::uint64_t>(setup.processes.place().rank) * training.batch),
      feed_(setup.clips, sampling(training, first_sample_), training.batch, training.frames),
      net_(std::move(network)) {
    if (training_.points == PointLoss::joints)
        joints_.emplace(spec.topology, spec.rest, spec.where, "rcxyz=none");
}

/// Standard normal numbers (N, W).
at::Tensor ActorLearner::noise(std::uint64_t step) const {
    const auto width = net_->settings().width;
    auto numbers = at::empty({training_.batch, width}, at::kFloat);
    cpu::normal_numbers({training_.seed, step, for_noise}, first_sample_, training_.batch, width,
                        numbers.data_ptr<float>(), at::get_num_threads());
    return numbers.to(setup().device);
}

void ActorLearner::step(std::uint64_t step, double rate_share) {
    const auto& settings = net_->settings();
    const auto windows = feed_.batch(step);
    const auto labels = labels_of(windows, setup().device);
    const auto real = values_of(windows, std::int64_t{settings.persons} * settings.representation.numbers(),
                                training_.frames, settings.nodes, setup().device);
    const ActorDropout dropout{settings.dropout, training_.seed, step, first_sample_};
    parameters().zero_gradients();
    const auto latent = net_->encode(real, labels, dropout);
    const auto drawn = latent.mean + noise(step) * (latent.log_variance / 2).exp();
    const auto made = net_->decode(drawn, labels, training_.frames, dropout);
    const auto found = actor_losses(real, made, latent, training_.kl_factor(), joints_ ? &*joints_ : nullptr);
    found.total.backward();
    const auto rcxyz = found.rcxyz.defined() ? found.rcxyz : at::zeros_like(found.rc);
    all_reduce_mean(at::stack({found.total, found.rc, rcxyz, found.kl}));
    move(rate_share);
}

Measures ActorLearner::losses(const std::vector<double>& sums, std::uint64_t steps) const {
    const auto n = static_cast<double>(steps);
    Measures all{{"loss", "loss", sums[0] / n}, {"rc", "rc", sums[1] / n}};
    if (joints_) all.push_back({"rcxyz", "rcxyz", sums[2] / n});
    all.push_back({"kl", "KL", sums[3] / (n * training_.batch)});
    return all;
}

}  // namespace actformer::model
