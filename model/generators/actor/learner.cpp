#include "model/generators/actor/learner.hpp"

#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>

#include "model/nn/module_arrays.hpp"
#include "model/nn/tensor_array.hpp"
#include "model/train/training.hpp"

namespace actformer::model {
namespace {

constexpr std::uint8_t for_noise = 1;  // of cpu::RandomPlace
constexpr std::int64_t losses_told = 4;

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

ActorLearner::ActorLearner(const Config& config, const MotionSpec& spec, const LearnerSetup& setup)
    : settings_(actor_settings(config, spec)),
      training_(actor_training(config, spec)),
      setup_(setup),
      first_sample_(static_cast<std::uint64_t>(setup.processes.place().rank) * training_.batch),
      feed_(setup.clips, sampling(training_, first_sample_), training_.batch, training_.frames),
      net_(network_of(settings_, training_.seed, setup.device)),
      ema_(net_),
      parameters_(net_->parameters(), losses_told),
      adam_(parameters_, training_.adam()),
      sums_(at::zeros({losses_told}, at::TensorOptions(at::kDouble).device(setup.device))) {
    if (training_.points == PointLoss::joints) joints_.emplace(spec.topology, spec.rest, spec.where);
    if (training_.average > 0) {
        ema_ = network_of(settings_, training_.seed, setup.device);
        ema_values_.emplace(ema_->parameters());
    }
    share(0);
}

/// Standard normal numbers (N, W).
at::Tensor ActorLearner::noise(std::uint64_t step) const {
    auto numbers = at::empty({training_.batch, settings_.width}, at::kFloat);
    cpu::normal_numbers({training_.seed, step, for_noise}, first_sample_, training_.batch, settings_.width,
                        numbers.data_ptr<float>(), at::get_num_threads());
    return numbers.to(setup_.device);
}

void ActorLearner::step(std::uint64_t step, double rate_share) {
    const auto windows = feed_.batch(step);
    const auto labels = labels_of(windows, setup_.device);
    const auto real = values_of(windows, std::int64_t{settings_.persons} * settings_.representation.numbers(),
                                training_.frames, settings_.nodes, setup_.device);
    const ActorDropout dropout{settings_.dropout, training_.seed, step, first_sample_};
    parameters_.zero_gradients();
    const auto latent = net_->encode(real, labels, dropout);
    const auto drawn = latent.mean + noise(step) * (latent.log_variance / 2).exp();
    const auto made = net_->decode(drawn, labels, training_.frames, dropout);
    const auto found = actor_losses(real, made, latent, training_.kl_factor(), joints_ ? &*joints_ : nullptr);
    found.total.backward();
    const auto rcxyz = found.rcxyz.defined() ? found.rcxyz : at::zeros_like(found.rc);
    parameters_.remarks().copy_(at::stack({found.total, found.rc, rcxyz, found.kl}).detach());
    setup_.processes.average(parameters_.message());
    adam_.step(rate_share);
    sums_.add_(parameters_.remarks());
    if (ema_values_) ema_values_->follow(parameters_, training_.average, adam_.steps);
}

Measures ActorLearner::losses(const std::vector<double>& sums, std::uint64_t steps) const {
    const auto n = static_cast<double>(steps);
    Measures all{{"loss", "loss", sums[0] / n}, {"rc", "rc", sums[1] / n}};
    if (joints_) all.push_back({"rcxyz", "rcxyz", sums[2] / n});
    all.push_back({"kl", "KL", sums[3] / (n * training_.batch)});
    return all;
}

bool ActorLearner::finite() {
    return at::isfinite(parameters_.values()).all().item<bool>();
}

/// What is no weight, but belongs to the state.
std::vector<at::Tensor> ActorLearner::optimiser_state() {
    std::vector<at::Tensor> all{adam_.squares(), adam_.means()};
    if (ema_values_) all.push_back(ema_values_->values());
    return all;
}

std::vector<Array> ActorLearner::state() {
    auto all = arrays_of(*net_, "network.");
    std::size_t i = 0;
    for (const auto& tensor : optimiser_state())
        all.push_back(array_of(fmt::format("state.{}", i++), tensor));
    return all;
}

void ActorLearner::load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) {
    adam_.steps = steps;
    load_arrays(*net_, "network.", state, where);
    std::size_t i = 0;
    for (const auto& tensor : optimiser_state())
        copy_into(tensor, array_named(state, fmt::format("state.{}", i++), where), where);
}

void ActorLearner::share(std::uint64_t steps) {
    adam_.steps = steps;
    const at::NoGradGuard no_gradients;
    setup_.processes.share(parameters_.values());
    for (auto& tensor : optimiser_state()) setup_.processes.share(tensor);
}

std::vector<Array> ActorLearner::weights() {
    return arrays_of(*net_, "");
}

std::vector<Array> ActorLearner::ema_weights() {
    return arrays_of(*ema_, "");
}

}  // namespace actformer::model
