#include "model/recognisers/learner.hpp"

#include <ATen/CPUGeneratorImpl.h>

#include "model/train/step_seed.hpp"
#include "model/train/torch_device.hpp"
#include "model/train/window_tensors.hpp"

namespace actformer::model {

RecogniserLearner::RecogniserLearner(const RecogniserSettings& settings,
                                     std::unique_ptr<RecogniserNetwork> network, std::size_t classes,
                                     Augmentation augmentation, const LearnerSetup& setup)
    : settings_(settings),
      device_(setup.device),
      table_(setup.clips.table()),
      classes_(classes),
      network_(std::move(network)),
      feed_(setup.clips, {settings.seed, kernels::ClassSampling::plain, true}, settings.batch,
            settings.frames),
      augmentation_(std::move(augmentation)),
      sums_(at::zeros({2}, at::TensorOptions(at::kDouble).device(device_))) {}

at::Tensor RecogniserLearner::values_of(const Windows& windows) const {
    return model::values_of(windows, std::int64_t{table_.persons} * table_.numbers, settings_.frames,
                            table_.nodes, device_)
        .to(torch_type(settings_.precision));
}

/// Joints that never move have a variance near 0, so batch normalisation amplifies any deviation about a hundredfold; noise gives
/// them a variance.
at::Tensor RecogniserLearner::noisy(const at::Tensor& motion, std::uint64_t seed) const {
    if (settings_.noise == 0) return motion;
    auto random = at::make_generator<at::CPUGeneratorImpl>(step_seed(seed, 1));
    const auto drawn = at::randn(motion.sizes(), random, at::TensorOptions(at::kFloat));
    return motion + settings_.noise * drawn.to(motion.options());
}

void RecogniserLearner::step(std::uint64_t step, double rate_share) {
    rate_ = settings_.rate * rate_share;
    const auto windows = feed_.batch(step);
    const auto labels = labels_of(windows, device_);
    const auto seed = step_seed(settings_.seed, step);
    const auto logits = network_->train_logits(noisy(augmentation_(values_of(windows), seed), seed), seed);
    const auto loss = at::cross_entropy_loss(logits, labels);
    loss.backward();
    network_->optimiser_step(rate_);
    sums_[0] += loss.detach();
    sums_[1] += logits.detach().argmax(1).eq(labels).sum();
}

Measures RecogniserLearner::losses(const std::vector<double>& sums, std::uint64_t steps) const {
    const auto n = static_cast<double>(steps);
    return {{"rate", "rate", rate_},
            {"loss", "loss", sums[0] / n},
            {"train_accuracy", "trained", sums[1] / (n * settings_.batch)}};
}

eval::Confusion RecogniserLearner::confusion_on(const kernels::ClipStore& clips) const {
    eval::Confusion confusion(classes_);
    for_each_window(clips, settings_.batch, settings_.frames, [&](const Windows& windows) {
        const auto guesses = network_->logits(values_of(windows)).argmax(1).to(at::kCPU);
        const auto* guess = guesses.data_ptr<std::int64_t>();
        for (std::uint32_t i = 0; i < windows.count; ++i)
            confusion.add(windows.labels[i], static_cast<std::size_t>(guess[i]));
    });
    return confusion;
}

void TestSplitValidator::begin(std::uint64_t epoch, std::uint64_t step) {
    confusion_ = learner_.confusion_on(clips_);
    const auto accuracy = confusion_->mean_class_accuracy();
    auto& validation = validation_.emplace();
    validation.report.epoch = epoch;
    validation.report.step = step;
    validation.report.values["class_accuracy"] = validation.selection_score = accuracy;
    validation.report.values["sample_accuracy"] = confusion_->sample_accuracy();
    validation.report.values["confusion"] = confusion_->rows();
    validation.weights = learner_.weights();
}

}  // namespace actformer::model
