#include "model/recognisers/learner.hpp"

#include "model/nn/module_arrays.hpp"
#include "model/nn/tensor_array.hpp"
#include "model/train/training.hpp"

namespace actformer::model {

RecogniserLearner::RecogniserLearner(const RecogniserSettings& settings, const StgcnSettings& network,
                                     const LearnerSetup& setup)
    : settings_(settings),
      device_(setup.device),
      net_(network, settings.seed, device_, torch_type(settings.precision)),
      sgd_(net_.trained(), {settings.momentum, settings.weight_decay, settings.nesterov}),
      feed_(setup.clips, {settings.seed, kernels::ClassSampling::plain, true}, settings.batch,
            settings.frames),
      sums_(at::zeros({2}, at::TensorOptions(at::kDouble).device(device_))) {}

at::Tensor RecogniserLearner::values_of(const Windows& windows) const {
    const auto& network = net_.settings();
    return model::values_of(windows, network.channels, settings_.frames, network.graph.joints(), device_)
        .to(torch_type(settings_.precision));
}

void RecogniserLearner::step(std::uint64_t step, double rate_share) {
    rate_ = settings_.rate * rate_share;
    const auto windows = feed_.batch(step);
    const auto labels = labels_of(windows, device_);
    const auto output = net_.train_forward(values_of(windows), step_seed(settings_.seed, step));
    const auto loss = at::cross_entropy_loss(output.logits, labels);
    loss.backward();
    sgd_.step(rate_);
    sums_[0] += loss.detach();
    sums_[1] += output.logits.detach().argmax(1).eq(labels).sum();
}

Measures RecogniserLearner::losses(const std::vector<double>& sums, std::uint64_t steps) const {
    const auto n = static_cast<double>(steps);
    return {{"rate", "rate", rate_},
            {"loss", "loss", sums[0] / n},
            {"train_accuracy", "trained", sums[1] / (n * settings_.batch)}};
}

bool RecogniserLearner::finite() {
    for (const auto& info : net_.infos())
        if (!at::isfinite(net_.weight(info.name)).all().item<bool>()) return false;
    return true;
}

std::vector<Array> RecogniserLearner::state() {
    auto arrays = net_.arrays();
    std::size_t i = 0;
    for (const auto& tensor : sgd_.momenta())
        arrays.push_back(array_of(fmt::format("momentum.{}", i++), tensor));
    return arrays;
}

void RecogniserLearner::load(const std::vector<Array>& state, std::uint64_t /*steps*/,
                             const std::string& where) {
    net_.load(state, where);
    std::size_t i = 0;
    for (const auto& tensor : sgd_.momenta())
        copy_into(tensor, array_named(state, fmt::format("momentum.{}", i++), where), where);
}

eval::Confusion RecogniserLearner::confusion_on(const kernels::ClipStore& clips) const {
    eval::Confusion confusion(net_.settings().classes);
    for_each_window(clips, settings_.batch, settings_.frames, [&](const Windows& windows) {
        const auto guesses = net_.eval_forward(values_of(windows)).logits.argmax(1).to(at::kCPU);
        const auto* guess = guesses.data_ptr<std::int64_t>();
        for (std::uint32_t i = 0; i < windows.count; ++i)
            confusion.add(windows.labels[i], static_cast<std::size_t>(guess[i]));
    });
    return confusion;
}

void TestSplitScorer::begin(Learner& learner, std::uint64_t epoch, std::uint64_t step) {
    confusion_ = dynamic_cast<RecogniserLearner&>(learner).confusion_on(clips_);
    const auto accuracy = confusion_->mean_class_accuracy();
    auto& scores = scores_.emplace();
    scores.report.epoch = epoch;
    scores.report.step = step;
    scores.report.values["class_accuracy"] = scores.merit = accuracy;
    scores.report.values["sample_accuracy"] = confusion_->sample_accuracy();
    scores.report.values["confusion"] = confusion_->rows();
    scores.weights = learner.weights();
}

}  // namespace actformer::model
