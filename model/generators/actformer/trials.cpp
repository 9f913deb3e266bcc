#include "model/generators/actformer/trials.hpp"

#include <algorithm>
#include <set>

#include "model/generators/actformer/gan.hpp"
#include "model/train/training.hpp"

namespace actformer::model {
namespace {

constexpr std::uint64_t scoring_draws = 2;  // of step_seed: neither the latents' nor the discriminator's

std::vector<std::uint32_t> classes_of(const kernels::ClipStore& clips) {
    const auto& labels = clips.table().labels;
    const std::set<std::uint32_t> each(labels.begin(), labels.end());
    return {each.begin(), each.end()};
}

}  // namespace

Trials::Trials(const GanSettings& settings, const ingest::Dataset& dataset, const kernels::ClipStore& clips)
    : seed_(step_seed(settings.seed, scoring_draws)),
      frames_(settings.frames),
      per_class_(settings.score_per_class),
      classes_(classes_of(clips)),
      judge_(settings.recogniser, settings.opencl, dataset, clips, settings.frames) {}

Labelled Trials::motions_of(Generator& generator) const {
    constexpr auto chunk = MotionMaker::chunk;
    Labelled all;
    const MotionMaker maker(generator, seed_, frames_);
    for (const auto label : classes_)
        for (std::uint32_t i = 0; i * chunk < per_class_; ++i) {
            const auto made = maker.make(label, i).narrow(0, 0, std::min(chunk, per_class_ - i * chunk));
            const auto* first = made.data_ptr<float>();
            all.values.insert(all.values.end(), first, first + made.numel());
            all.labels.insert(all.labels.end(), static_cast<std::size_t>(made.size(0)), label);
        }
    return all;
}

void Trials::begin(Generator& generator, std::uint64_t epoch, std::uint64_t step) {
    trial_ = {epoch, step, arrays_of(generator, ""), {}};
    scores_ = std::async(std::launch::async,
                         [this, motions = motions_of(generator)] { return judge_.score(motions); });
}

std::optional<Trial> Trials::end() {
    if (!scores_.valid()) return std::nullopt;
    trial_.scores = scores_.get();
    return std::move(trial_);
}

}  // namespace actformer::model
