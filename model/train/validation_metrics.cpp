#include "model/train/validation_metrics.hpp"

#include "base/error.hpp"
#include "eval/metrics/confusion.hpp"
#include "eval/metrics/fid.hpp"
#include "eval/scoring/feature_extractor.hpp"
#include "eval/scoring/windows_source.hpp"
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

}  // namespace

struct ValidationMetrics::Parts {
    Parts(const std::filesystem::path& recogniser, const std::string& opencl)
        : device(checked(opencl)), extractor(device, recogniser, together) {}

    /// `count` sequences (count, P*D, frames, K) with their labels, added to `samples`.
    void see(std::span<const float> values, std::span<const std::uint32_t> labels, eval::Samples& samples) {
        const auto got = extractor.extract(values, static_cast<std::uint32_t>(labels.size()), frames);
        samples.features.insert(samples.features.end(), got.features.begin(), got.features.end());
        samples.logits.insert(samples.logits.end(), got.logits.begin(), got.logits.end());
        samples.labels.insert(samples.labels.end(), labels.begin(), labels.end());
    }

    eval::Samples nothing() const { return {extractor.features(), extractor.classes(), {}, {}, {}}; }

    kernels::Device device;
    eval::FeatureExtractor extractor;
    eval::Statistics real;
    double real_accuracy = 0;
    std::uint32_t frames = 0;
};

ValidationMetrics::ValidationMetrics(const std::filesystem::path& recogniser, const std::string& opencl,
                                     const ingest::Dataset& dataset, const kernels::ClipStore& clips,
                                     std::uint32_t frames)
    : parts_(std::make_unique<Parts>(recogniser, opencl)) {
    const auto motions = eval::describe(dataset);
    parts_->extractor.check_fits(motions);
    parts_->extractor.check_classes(motions);
    parts_->frames = frames;
    auto samples = parts_->nothing();
    const auto one = clips.table().frame_values() * frames;
    for_each_window(clips, together, frames, [&](const Windows& windows) {
        parts_->see({windows.values, windows.count * one}, {windows.labels, windows.count}, samples);
    });
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
