#include "eval/scoring/feature_extractor.hpp"

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/text/counted.hpp"
#include "eval/metrics/fid.hpp"
#include "eval/run_weights.hpp"
#include "eval/scoring/common_view.hpp"
#include "eval/stgcn/graph.hpp"
#include "ingest/dataset/motions_file.hpp"

namespace actformer::eval {
namespace {

/// The recogniser's tree is the skeleton's, or the one that NTU's recognisers use for it.
bool same_tree(const std::vector<int>& recogniser, const std::vector<int>& skeleton) {
    if (recogniser == skeleton) return true;
    return recogniser == recogniser_graph(skeleton).parents;
}

}  // namespace

FeatureExtractor::FeatureExtractor(kernels::Device& device, const std::filesystem::path& recogniser,
                                   std::uint32_t batch, Persons persons,
                                   std::optional<std::uint64_t> initial_noise)
    : weights_(weights_of(recogniser)),
      checksum_(checksum_file(weights_) + (initial_noise ? fmt::format(" noise {}", *initial_noise) : "")),
      recogniser_(open_recogniser(device, weights_, batch, initial_noise)),
      persons_(persons) {}

ingest::Joints FeatureExtractor::joints_of(const MotionsInfo& motions) const {
    return sees_common_joints(recogniser().parents, motions) ? ingest::Joints::common15 : ingest::Joints::own;
}

void FeatureExtractor::check_fits(const MotionsInfo& motions) const {
    if (joints_of(motions) == ingest::Joints::own) return check_seen(motions);
    check_seen(in_common_joints(motions));
}

void FeatureExtractor::check_seen(const MotionsInfo& motions) const {
    const auto& r = recogniser();
    if (motions.representation && *motions.representation != r.representation)
        throw Error(
            "{}: its motions are in {} and the recogniser {} takes {}; choose one trained on such motions",
            motions.source, motions.representation->name(), r.source, r.representation.name());
    const bool apart = persons_ == Persons::apart;
    if (apart && motions.persons > 1 && r.channels != motions.channels / motions.persons)
        throw Error(
            "{}: takes {} channels; the recogniser that sees the persons of {} apart must take one person, "
            "{}",
            r.source, r.channels, motions.source, motions.channels / motions.persons);
    if (r.channels == 0 || (apart ? motions.channels % r.channels != 0 : motions.channels != r.channels) ||
        motions.joints != r.joints())
        throw Error(
            "{}: {} has {} channels (numbers a joint, of all persons) and {} joints where the recogniser "
            "{} "
            "takes {} and {}; choose one trained on such motions",
            motions.source, motions.names.empty() ? "a clip" : "'" + motions.names[0] + "'", motions.channels,
            motions.joints, r.source, r.channels, r.joints());
    if (!motions.representation && r.representation == ingest::Representation::limb)
        ingest::MotionsFile(motions.source).check_limbs();  // only a file leaves its representation open
    if (!motions.parents.empty() && !same_tree(r.parents, motions.parents))
        throw Error(
            "{}: its skeleton is another tree than that of the recogniser {}; choose one trained on such "
            "motions",
            motions.source, r.source);
}

void FeatureExtractor::check_classes(const MotionsInfo& motions) const {
    if (persons_ == Persons::apart) return;
    const auto& r = recogniser();
    if (!motions.classes.empty() && motions.classes.size() != r.classes)
        throw Error("{}: has {} and the recogniser {} knows {}; choose one trained on such a dataset",
                    motions.source, counted(motions.classes.size(), "class"), r.source, r.classes);
    for (std::size_t i = 0; i < motions.labels.size(); ++i)
        if (motions.labels[i] >= r.classes)
            throw Error("{}: '{}' is of action {} and the recogniser {} knows {}", motions.source,
                        motions.names[i], motions.labels[i] + 1, r.source, counted(r.classes, "class"));
}

void FeatureExtractor::begin_set(const MotionsInfo& motions) {
    recogniser_->begin_set(motions.fingerprint);
}

Recognised FeatureExtractor::extract(const MotionBatch& batch, const MotionsInfo& motions) {
    const bool common = joints_of(motions) == ingest::Joints::common15;
    const auto channels = common ? 3 * motions.persons : motions.channels;
    const auto persons = channels / recogniser().channels;
    const auto sequences = static_cast<std::uint32_t>(batch.rows.size()) * persons;
    auto seen = common ? recogniser_->recognise(in_common_joints(batch, motions), sequences, batch.frames)
                : batch.on_device ? recogniser_->recognise(*batch.on_device, sequences, batch.frames)
                                  : recogniser_->recognise(batch.values, sequences, batch.frames);
    if (persons_ == Persons::together) return seen;
    return {largest_of_group(seen.features, features(), persons), {}};
}

Recognised FeatureExtractor::extract(std::span<const float> values, std::uint32_t count,
                                     std::uint32_t frames) {
    return recogniser_->recognise(values, count, frames);
}

}  // namespace actformer::eval
