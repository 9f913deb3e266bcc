#include "model/generators/generator_validator.hpp"

#include <algorithm>
#include <set>

#include "base/threads/thread.hpp"
#include "model/train/step_seed.hpp"

namespace actformer::model {
namespace {

std::vector<std::uint32_t> classes_of(const kernels::ClipStore& clips) {
    const auto& labels = clips.table().labels;
    const std::set<std::uint32_t> each(labels.begin(), labels.end());
    return {each.begin(), each.end()};
}

}  // namespace

GeneratorValidator::GeneratorValidator(const Config& config, const MotionSpec& spec,
                                       const ingest::Dataset& dataset, const kernels::ClipStore& clips,
                                       std::string device, Learner& learner)
    : config_(config),
      spec_(spec),
      settings_(generator_trainer_settings(config)),
      device_(std::move(device)),
      learner_(learner),
      frames_(static_cast<std::uint32_t>(config.get<std::int64_t>("frames"))),
      classes_(classes_of(clips)),
      metrics_(settings_.recogniser, settings_.opencl, dataset, settings_.train_split, clips, frames_) {}

/// FIDs fall as motions grow more.
std::string GeneratorValidator::fingerprint() const {
    return fmt::format("{}, {} motions a class", metrics_.checksum(), settings_.score_per_class);
}

Labelled GeneratorValidator::motions_of(const std::vector<Array>& weights) const {
    const auto maker = method_named(config_.model(), spec_.where).maker(config_, spec_, weights, device_);
    const auto seed = step_seed(settings_.seed, scoring_part);
    const auto batch = maker->batch(), wanted = settings_.score_per_class;
    Labelled all;
    for (const auto label : classes_)
        for (std::uint32_t i = 0; i * batch < wanted; ++i) {
            const auto motions = maker->make(seed, label, i, frames_);
            const std::size_t count = std::min(batch, wanted - i * batch), one = motions.size() / batch;
            all.values.insert(all.values.end(), motions.begin(),
                              motions.begin() + static_cast<std::ptrdiff_t>(count * one));
            all.labels.insert(all.labels.end(), count, label);
        }
    return all;
}

void GeneratorValidator::begin(std::uint64_t epoch, std::uint64_t step) {
    validation_.report.epoch = epoch;
    validation_.report.step = step;
    validation_.weights = learner_.keeps_ema() ? learner_.ema_weights() : learner_.weights();
    auto motions = motions_of(validation_.weights);
    try {
        scores_ = std::async(std::launch::async,
                             [this, motions = std::move(motions)] { return metrics_.score(motions); });
    } catch (const std::system_error& e) {
        fail_without_thread(e);
    }
}

std::optional<Validation> GeneratorValidator::end() {
    if (!scores_.valid()) return std::nullopt;
    const auto found = scores_.get();
    validation_.report.values = {{"accuracy", found.accuracy},
                                 {"real_accuracy", metrics_.real_accuracy()},
                                 {"fid_whole", found.fid_whole}};
    if (found.fid_mean) validation_.report.values["fid_mean"] = *found.fid_mean;
    validation_.selection_score = -found.fid_whole;
    return std::move(validation_);
}

}  // namespace actformer::model
