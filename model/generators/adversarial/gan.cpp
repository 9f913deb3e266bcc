#include "model/generators/adversarial/gan.hpp"

#include <ATen/core/grad_mode.h>

#include "base/error.hpp"
#include "model/generators/adversarial/spread.hpp"
#include "model/nn/autocast.hpp"
#include "model/nn/module_arrays.hpp"
#include "model/train/training.hpp"

namespace actformer::model {
namespace {

at::Tensor discriminator_loss(Loss loss, const at::Tensor& real, const at::Tensor& fake) {
    if (loss == Loss::wasserstein) return fake.mean() - real.mean();
    return at::relu(1 - real).mean() + at::relu(1 + fake).mean();
}

/// Whether the passes of every step are the same but for what they read.
bool always_alike(const GanSettings& s) {
    return s.mirror == 0 && s.turn == 0 && s.spread == 0;
}

/// Puts values where those of the step before were, so that work once recorded finds them; on processors it takes them as they are.
void put(at::Tensor& to, const at::Tensor& values) {
    if (values.is_cpu())
        to = values;
    else if (to.defined() && to.sizes() == values.sizes())
        to.copy_(values);
    else
        to = values.clone();
}

}  // namespace

Gan::Gan(const GanSettings& settings, GanNetworks networks, const at::Device& device,
         const Processes& processes, Augmentation augmentation)
    : settings_(settings),
      device_(device),
      processes_(processes),
      networks_(std::move(networks)),
      prior_(networks_.generator->prior(), step_seed(settings.seed, latents_part)),
      augmentation_(std::move(augmentation)),
      generator_parameters_(networks_.generator->parameters(), 1),
      discriminator_parameters_(networks_.discriminator->parameters(), 3),
      generator_adam_(generator_parameters_, settings.generator_adam()),
      discriminator_adam_(discriminator_parameters_, settings.discriminator_adam()),
      discriminator_work_(device, settings.cuda_graphs && always_alike(settings)),
      generator_work_(device, settings.cuda_graphs && always_alike(settings)),
      sums_(at::zeros({4}, at::TensorOptions(at::kDouble).device(device))) {
    if (networks_.ema) ema_parameters_.emplace(networks_.ema->parameters());
    share(0);
}

at::Tensor Gan::latent(const at::Tensor& labels, std::uint64_t draw) {
    const auto first = static_cast<std::uint64_t>(processes_.place().rank * labels.size(0));
    const auto frames = networks_.generator->latent_frames(settings_.frames);
    const auto drawn = prior_.draw(draw, labels.size(0), frames, first);
    return device_.is_cpu() ? drawn : drawn.pin_memory().to(device_, at::kFloat, /*non_blocking=*/true);
}

at::Tensor Gan::fake() {
    return networks_.generator->generate(latent_, labels_, settings_.frames);
}

/// Every process augments its motions in its own way.
at::Tensor Gan::augmented(const at::Tensor& motion, std::uint64_t draw) const {
    const auto seed = step_seed(settings_.seed, augmentation_part);
    return augmentation_(motion, step_seed(seed, draw * static_cast<std::uint64_t>(processes_.place().size) +
                                                     static_cast<std::uint64_t>(processes_.place().rank)));
}

/// What a step's passes read.
void Gan::take(const at::Tensor& real, const at::Tensor& labels, std::uint64_t draw) {
    put(real_, real);
    put(labels_, labels);
    put(latent_, latent(labels, draw));
}

void Gan::discriminator_gradients(std::uint64_t draw) {
    at::Tensor scores;
    {
        const Autocast reduced(settings_.bf16);
        at::Tensor fake;
        {
            const at::NoGradGuard no_gradients;
            fake = this->fake().to(at::kFloat);
        }
        const auto seen = augmented(at::cat({real_, fake}), draw);
        scores = networks_.discriminator->forward(seen, at::cat({labels_, labels_})).to(at::kFloat);
    }
    const auto of = scores.chunk(2);
    const auto loss = discriminator_loss(settings_.loss, of[0], of[1]);
    loss.backward();
    discriminator_parameters_.appended_values().copy_(
        at::stack({loss.detach(), of[0].detach().mean(), of[1].detach().mean()}));
}

void Gan::step_discriminator(const at::Tensor& real, const at::Tensor& labels, std::uint64_t draw) {
    take(real, labels, draw);
    discriminator_parameters_.zero_gradients();
    discriminator_work_.run([this, draw] { discriminator_gradients(draw); });
    processes_.average(discriminator_parameters_.all_reduce_buffer());
    discriminator_adam_.step(rate_share_);
    sums_.narrow(0, 0, 3).add_(discriminator_parameters_.appended_values());
}

void Gan::generator_gradients(std::uint64_t draw) {
    discriminator_parameters_.want_gradients(false);
    at::Tensor scores, made;
    {
        const Autocast reduced(settings_.bf16);
        made = fake();
        scores = networks_.discriminator->forward(augmented(made, draw), labels_).to(at::kFloat);
    }
    auto loss = -scores.mean();
    if (settings_.spread > 0) loss = loss + settings_.spread * spread_loss(real_, made, labels_);
    loss.backward();
    discriminator_parameters_.want_gradients(true);
    generator_parameters_.appended_values().copy_(loss.detach().view({1}));
}

void Gan::step_generator(const at::Tensor& real, const at::Tensor& labels, std::uint64_t draw) {
    take(real, labels, draw);
    generator_parameters_.zero_gradients();
    generator_work_.run([this, draw] { generator_gradients(draw); });
    processes_.average(generator_parameters_.all_reduce_buffer());
    generator_adam_.step(rate_share_);
    sums_.narrow(0, 3, 1).add_(generator_parameters_.appended_values());
    if (ema_parameters_)
        ema_parameters_->follow(generator_parameters_, settings_.average, generator_adam_.steps);
}

GanGenerator& Gan::ema() {
    if (!networks_.ema) return generator();
    const at::NoGradGuard no_gradients;
    const auto from = generator().named_buffers();
    for (auto& item : networks_.ema->named_buffers()) item.value().copy_(from[item.key()]);
    networks_.ema->recompute_buffers(prior_, settings_.frames);
    return *networks_.ema;
}

bool Gan::finite() {
    return at::isfinite(generator_parameters_.values()).all().item<bool>() &&
           at::isfinite(discriminator_parameters_.values()).all().item<bool>();
}

/// What is neither a parameter nor a buffer, but belongs to the state.
std::vector<at::Tensor> Gan::optimiser_state() {
    std::vector<at::Tensor> all{generator_adam_.squares(), discriminator_adam_.squares()};
    for (auto* adam : {&generator_adam_, &discriminator_adam_})
        if (adam->means().defined()) all.push_back(adam->means());
    if (ema_parameters_) all.push_back(ema_parameters_->values());
    return all;
}

std::vector<Array> Gan::state() {
    auto all = arrays_of(generator(), "generator.");
    for (auto& array : arrays_of(*networks_.discriminator, "discriminator.")) all.push_back(std::move(array));
    add_state(all, optimiser_state());
    return all;
}

void Gan::load(const std::vector<Array>& arrays, std::uint64_t steps, const std::string& where) {
    count(steps);
    load_arrays(generator(), "generator.", arrays, where);
    load_arrays(*networks_.discriminator, "discriminator.", arrays, where);
    load_state(optimiser_state(), arrays, where);
}

void Gan::count(std::uint64_t steps) {
    generator_adam_.steps = steps;
    discriminator_adam_.steps = steps * settings_.discriminator_steps;
}

void Gan::share(std::uint64_t steps) {
    count(steps);
    const at::NoGradGuard no_gradients;
    processes_.share(generator_parameters_.values());
    processes_.share(discriminator_parameters_.values());
    for (auto& tensor : generator().buffers()) processes_.share(tensor);
    for (auto& tensor : networks_.discriminator->buffers()) processes_.share(tensor);
    for (auto& tensor : optimiser_state()) processes_.share(tensor);
}

}  // namespace actformer::model
