#include "model/generators/adversarial/learner.hpp"

#include "model/generators/adversarial/collapse.hpp"
#include "model/nn/module_arrays.hpp"
#include "model/train/window_tensors.hpp"

namespace actformer::model {
namespace {

std::uint32_t batch_of(const Config& config) {
    return static_cast<std::uint32_t>(config.get<std::int64_t>("batch"));
}

/// Every process takes its own part of the windows.
kernels::SamplerOptions sampling(const Config& config, const Place& place) {
    return {static_cast<std::uint64_t>(config.get<std::int64_t>("seed")), kernels::ClassSampling::square_root,
            true, static_cast<std::uint32_t>(place.rank) * batch_of(config)};
}

/// (N) int64: classes as the training draws them, of a batch that it never comes to. Those without a clip are never trained.
at::Tensor drawn_labels(const kernels::ClipTable& clips, const Config& config) {
    constexpr std::uint32_t count = 1024;
    constexpr std::uint64_t batch = std::uint64_t{1} << 55U;
    const auto options = sampling(config, {});
    const auto classes = kernels::class_table(clips, options.classes);
    const auto labels = at::empty({count}, at::kLong);
    auto* to = labels.data_ptr<std::int64_t>();
    for (std::uint32_t i = 0; i < count; ++i)
        to[i] = clips.labels[kernels::drawn(clips, classes, options, batch, i, 1).clip];
    return labels;
}

}  // namespace

GanLearner::GanLearner(const Config& config, const MotionSpec& spec, GanNetworks networks,
                       const LearnerSetup& setup)
    : settings_(gan_settings(config)),
      channels_(std::int64_t{spec.numbers()} * spec.persons),
      nodes_(spec.nodes()),
      batch_(batch_of(config)),
      device_(setup.device),
      feed_(setup.clips, sampling(config, setup.processes.place()), batch_, settings_.frames),
      gan_(settings_, std::move(networks), setup.device, setup.processes,
           Augmentation(settings_, spec.representation, spec.topology, spec.where)),
      ema_labels_(drawn_labels(setup.clips.table(), config)) {}

std::uint64_t GanLearner::windows_a_step() const {
    return std::uint64_t{batch_} * settings_.discriminator_steps;
}

void GanLearner::step(std::uint64_t step, double rate_share) {
    const auto steps = std::uint64_t{settings_.discriminator_steps};
    gan_.set_rate_share(rate_share);
    at::Tensor real, labels;
    for (std::uint64_t i = 0; i < steps; ++i) {
        const auto windows = feed_.batch(step * steps + i);
        labels = labels_of(windows, device_);
        real = values_of(windows, channels_, settings_.frames, nodes_, device_);
        gan_.step_discriminator(real, labels, step * (steps + 1) + i);
    }
    gan_.step_generator(real, labels, step * (steps + 1) + steps);
}

Measures GanLearner::losses(const std::vector<double>& sums, std::uint64_t steps) const {
    const auto g = static_cast<double>(steps), d = g * settings_.discriminator_steps;
    return {{"discriminator_loss", "D", sums[0] / d},
            {"generator_loss", "G", sums[3] / g},
            {"real_score", "real", sums[1] / d},
            {"fake_score", "fake", sums[2] / d}};
}

std::string GanLearner::trouble(const Measures& losses) const {
    return collapse_in({value_of(losses, "discriminator_loss"), value_of(losses, "real_score"),
                        value_of(losses, "fake_score"), value_of(losses, "generator_loss")},
                       settings_.loss);
}

std::vector<Array> GanLearner::weights() {
    return arrays_of(gan_.generator(), "");
}

std::vector<Array> GanLearner::ema_weights() {
    return arrays_of(gan_.ema(ema_labels_), "");
}

std::vector<Phase> GanLearner::phases() {
    const auto windows = feed_.batch(0);
    const auto labels = labels_of(windows, device_);
    const auto real = values_of(windows, channels_, settings_.frames, nodes_, device_);
    return {
        {"discriminator step",
         [=, this](std::uint64_t number) { gan_.step_discriminator(real, labels, number); }},
        {"generator step", [=, this](std::uint64_t number) { gan_.step_generator(real, labels, number); }}};
}

}  // namespace actformer::model
