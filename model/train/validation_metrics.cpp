#include "model/train/validation_metrics.hpp"

#include "base/error.hpp"
#include "eval/metrics/confusion.hpp"
#include "eval/metrics/fid.hpp"
#include "eval/scoring/feature_extractor.hpp"
#include "eval/scoring/windows_source.hpp"
#include "ingest/dataset/subjects.hpp"
#include "ingest/dataset/view.hpp"
#include "model/train/window_feed.hpp"

namespace actformer::model {
namespace {

constexpr std::uint32_t together = 64;

const std::string& checked(const std::string& opencl) {
    if (opencl == no_opencl)
        throw Error(
            "recogniser=: scores are computed in OpenCL, and opencl=none keeps it out; leave one of them "
            "out");
    return opencl;
}

/// The dataset's clips, or motions generated from it: these have its clips' mean bone lengths.
eval::MotionsInfo described(const ingest::Dataset& dataset) {
    auto motions = eval::describe(dataset);
    motions.body = ingest::subjects_of(dataset);
    return motions;
}

}  // namespace

struct ValidationMetrics::Parts {
    Parts(const std::filesystem::path& recogniser, const std::string& opencl, const ingest::Dataset& dataset,
          std::uint32_t window)
        : device(checked(opencl)),
          extractor(device, recogniser, together),
          motions(described(dataset)),
          frames(window) {
        extractor.check_fits(motions);
        extractor.check_classes(motions);
        motions.names = {"a generated motion"};
    }

    /// Every consecutive window of `clips`, in the joints that the recogniser sees.
    eval::Samples real_samples(const kernels::ClipStore& clips) {
        auto samples = nothing();
        const auto one = clips.table().frame_values() * frames;
        for_each_window(clips, together, frames, [&](const Windows& windows) {
            add(extractor.extract({windows.values, windows.count * one}, windows.count, frames),
                {windows.labels, windows.count}, samples);
        });
        return samples;
    }

    /// Generated motions, values (labels.size(), P*D, frames, K) in the dataset's joints.
    void see(std::span<const float> values, std::span<const std::uint32_t> labels, eval::Samples& samples) {
        const std::vector<std::uint64_t> all_called_alike(labels.size(), 0);
        add(extractor.extract({all_called_alike, frames, values}, motions), labels, samples);
    }

    void add(const eval::Recognised& got, std::span<const std::uint32_t> labels,
             eval::Samples& samples) const {
        samples.features.insert(samples.features.end(), got.features.begin(), got.features.end());
        samples.logits.insert(samples.logits.end(), got.logits.begin(), got.logits.end());
        samples.labels.insert(samples.labels.end(), labels.begin(), labels.end());
    }

    eval::Samples nothing() const { return {extractor.features(), extractor.classes(), {}, {}, {}}; }

    kernels::Device device;
    eval::FeatureExtractor extractor;
    eval::MotionsInfo motions;
    std::uint32_t frames;
    eval::Statistics real;
    double real_accuracy = 0;
};

ValidationMetrics::ValidationMetrics(const std::filesystem::path& recogniser, const std::string& opencl,
                                     const ingest::Dataset& dataset, const std::string& split,
                                     const kernels::ClipStore& clips, std::uint32_t frames)
    : parts_(std::make_unique<Parts>(recogniser, opencl, dataset, frames)) {
    const auto joints = parts_->extractor.joints_of(parts_->motions);
    const auto samples =
        joints == ingest::Joints::own
            ? parts_->real_samples(clips)
            : parts_->real_samples(ingest::load_view(parts_->device, dataset, split, joints).store);
    parts_->real = eval::statistics_of(samples);
    parts_->real_accuracy = eval::confusion_of(samples).mean_class_accuracy();
}

ValidationMetrics::~ValidationMetrics() = default;

double ValidationMetrics::real_accuracy() const {
    return parts_->real_accuracy;
}

std::size_t ValidationMetrics::real_windows() const {
    return parts_->real.samples;
}

const std::string& ValidationMetrics::checksum() const {
    return parts_->extractor.checksum();
}

ValidationScores ValidationMetrics::score(const Labelled& motions) {
    auto samples = parts_->nothing();
    const auto one = motions.values.size() / motions.labels.size();
    for (std::size_t first = 0; first < motions.labels.size(); first += together) {
        const auto count = std::min<std::size_t>(together, motions.labels.size() - first);
        parts_->see(std::span(motions.values).subspan(first * one, count * one),
                    std::span(motions.labels).subspan(first, count), samples);
    }
    const auto apart = eval::distances(parts_->real, eval::statistics_of(samples));
    return {eval::confusion_of(samples).mean_class_accuracy(), apart.whole, apart.mean};
}

}  // namespace actformer::model
