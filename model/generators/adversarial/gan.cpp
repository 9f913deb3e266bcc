#include "model/generators/adversarial/gan.hpp"

#include <ATen/core/grad_mode.h>

#include "base/error.hpp"
#include "model/generators/adversarial/spread.hpp"
#include "model/nn/autocast.hpp"
#include "model/nn/module_arrays.hpp"
#include "model/train/step_seed.hpp"

namespace actformer::model {
namespace {

at::Tensor discriminator_loss(Loss loss, const at::Tensor& real, const at::Tensor& fake) {
    if (loss == Loss::wasserstein) return fake.mean() - real.mean();
    return at::relu(1 - real).mean() + at::relu(1 + fake).mean();
}

/// Augmentation draws its random numbers on the host.
bool augments(const GanSettings& settings) {
    return settings.mirror > 0 || settings.turn > 0;
}

/// Into the memory of the step before, where graphs read it.
void replace(at::Tensor& held, const at::Tensor& values, const at::Device& device) {
    if (!held.defined()) held = at::empty_like(values, at::TensorOptions(device));
    TORCH_CHECK(held.sizes() == values.sizes(), "steps of one training have batches of one size");
    held.copy_(values, /*non_blocking=*/true);
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
      discriminator_graph_(device, settings.cuda_graphs && !augments(settings)),
      // The loss of `spread` sorts labels, which may wait for the device.
      generator_graph_(device, settings.cuda_graphs && !augments(settings) && settings.spread == 0),
      sums_(at::zeros({4}, at::TensorOptions(at::kDouble).device(device))) {
    if (networks_.ema) ema_parameters_.emplace(networks_.ema->parameters());
    broadcast(0);
}

at::Tensor Gan::latent(const at::Tensor& labels, std::uint64_t draw) {
    const auto first = static_cast<std::uint64_t>(processes_.place().rank * labels.size(0));
    const auto frames = networks_.generator->latent_frames(settings_.frames);
    const auto drawn = prior_.draw(draw, labels.size(0), frames, first);
    return device_.is_cpu() ? drawn : drawn.pin_memory();
}

at::Tensor Gan::fake(const Inputs& in) {
    return networks_.generator->generate(in.latent, in.labels, settings_.frames);
}

/// Every process augments its motions in its own way.
at::Tensor Gan::augmented(const at::Tensor& motion, std::uint64_t draw) const {
    const auto seed = step_seed(settings_.seed, augmentation_part);
    return augmentation_(motion, step_seed(seed, draw * static_cast<std::uint64_t>(processes_.place().size) +
                                                     static_cast<std::uint64_t>(processes_.place().rank)));
}

Gan::Inputs Gan::inputs(const at::Tensor& real, const at::Tensor& labels, std::uint64_t draw) {
    const auto z = latent(labels, draw);
    if (device_.is_cpu()) return {real, labels, z};
    replace(static_inputs_.real, real, device_);
    replace(static_inputs_.labels, labels, device_);
    replace(static_inputs_.latent, z, device_);
    return static_inputs_;
}

void Gan::discriminator_gradients(const Inputs& in, std::uint64_t draw) {
    at::Tensor scores;
    {
        const Autocast reduced(settings_.bf16);
        at::Tensor fake;
        {
            const at::NoGradGuard no_gradients;
            fake = this->fake(in).to(at::kFloat);
        }
        const auto seen = augmented(at::cat({in.real, fake}), draw);
        scores = networks_.discriminator->forward(seen, at::cat({in.labels, in.labels})).to(at::kFloat);
    }
    const auto of = scores.chunk(2);
    const auto loss = discriminator_loss(settings_.loss, of[0], of[1]);
    loss.backward();
    discriminator_parameters_.appended_values().copy_(
        at::stack({loss.detach(), of[0].detach().mean(), of[1].detach().mean()}));
}

void Gan::step_discriminator(const at::Tensor& real, const at::Tensor& labels, std::uint64_t draw) {
    const auto in = inputs(real, labels, draw);
    discriminator_parameters_.zero_gradients();
    discriminator_graph_.run([&] { discriminator_gradients(in, draw); });
    processes_.all_reduce_mean(discriminator_parameters_.all_reduce_buffer());
    discriminator_adam_.step(rate_share_);
    sums_.narrow(0, 0, 3).add_(discriminator_parameters_.appended_values());
}

void Gan::generator_gradients(const Inputs& in, std::uint64_t draw) {
    discriminator_parameters_.want_gradients(false);
    at::Tensor scores, made;
    {
        const Autocast reduced(settings_.bf16);
        made = fake(in);
        scores = networks_.discriminator->forward(augmented(made, draw), in.labels).to(at::kFloat);
    }
    auto loss = -scores.mean();
    if (settings_.spread > 0) loss = loss + settings_.spread * spread_loss(in.real, made, in.labels);
    loss.backward();
    discriminator_parameters_.want_gradients(true);
    generator_parameters_.appended_values().copy_(loss.detach().view({1}));
}

void Gan::step_generator(const at::Tensor& real, const at::Tensor& labels, std::uint64_t draw) {
    const auto in = inputs(real, labels, draw);
    generator_parameters_.zero_gradients();
    generator_graph_.run([&] { generator_gradients(in, draw); });
    processes_.all_reduce_mean(generator_parameters_.all_reduce_buffer());
    generator_adam_.step(rate_share_);
    sums_.narrow(0, 3, 1).add_(generator_parameters_.appended_values());
    if (ema_parameters_)
        ema_parameters_->follow(generator_parameters_, settings_.average, generator_adam_.steps);
}

GanGenerator& Gan::ema(const at::Tensor& labels) {
    if (!networks_.ema) return generator();
    const at::NoGradGuard no_gradients;
    const auto from = generator().named_buffers();
    for (auto& item : networks_.ema->named_buffers()) item.value().copy_(from[item.key()]);
    networks_.ema->recompute_buffers(prior_, labels, settings_.frames);
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

void Gan::broadcast(std::uint64_t steps) {
    count(steps);
    const at::NoGradGuard no_gradients;
    processes_.broadcast(generator_parameters_.values());
    processes_.broadcast(discriminator_parameters_.values());
    for (auto& tensor : generator().buffers()) processes_.broadcast(tensor);
    for (auto& tensor : networks_.discriminator->buffers()) processes_.broadcast(tensor);
    for (auto& tensor : optimiser_state()) processes_.broadcast(tensor);
}

}  // namespace actformer::model
