// A recogniser that is opened once and shown motions from any source.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "eval/recogniser.hpp"
#include "eval/scoring/motion_source.hpp"
#include "ingest/dataset/common_joints.hpp"

namespace actformer::eval {

class FeatureExtractor {
  public:
    /// How it sees several persons: together on the channels, or, by a one-person recogniser, each alone. In the latter case a
    /// group's features are the largest of its persons' in every channel (FIDa), and there are no logits: the
    /// recogniser's classes are others than the motions'.
    enum class Persons { together, apart };

    /// `recogniser`: folder of a training, or weights (see weights_of). `batch`: the most motions that will be shown together.
    /// `initial_noise`: see open_recogniser. `device` must outlive the extractor. Throws Error as open_recogniser does.
    FeatureExtractor(kernels::Device& device, const std::filesystem::path& recogniser,
                     std::uint32_t batch = 64, Persons persons = Persons::together,
                     std::optional<std::uint64_t> initial_noise = {});

    const std::filesystem::path& weights() const { return weights_; }
    const std::string& checksum() const { return checksum_; }  ///< of the weights, and with noise its seed
    const RecogniserInfo& recogniser() const { return recogniser_->info(); }
    Persons persons() const { return persons_; }
    std::uint32_t features() const { return recogniser().features; }
    std::uint32_t classes() const { return persons_ == Persons::apart ? 0 : recogniser().classes; }

    /// The joints that the recogniser must be shown of such motions: the common ones where it was trained on those.
    ingest::Joints joints_of(const MotionsInfo& motions) const;

    /// Throws Error, one line, unless the recogniser can be shown these motions, or the common joints of them: representation,
    /// channels, joints and tree (for NTU's 25 joints, whose hands the recogniser links otherwise, either tree).
    void check_fits(const MotionsInfo& motions) const;

    /// Throws Error unless the motions' labels and classes are the recogniser's. Of Persons::apart they do not matter.
    void check_classes(const MotionsInfo& motions) const;

    /// The batches that follow are of `motions`, from their first one on.
    void begin_set(const MotionsInfo& motions);

    /// A batch of motions that fit: features (rows, features()) and logits (rows, classes()). Motions of which the common
    /// joints are seen come in host memory.
    Recognised extract(const MotionBatch& batch, const MotionsInfo& motions);

    /// The same of motions in memory: values (count, channels, frames, K), persons together.
    Recognised extract(std::span<const float> values, std::uint32_t count, std::uint32_t frames);

  private:
    void check_seen(const MotionsInfo& motions) const;

    std::filesystem::path weights_;
    std::string checksum_;
    std::unique_ptr<Recogniser> recogniser_;
    Persons persons_;
};

}  // namespace actformer::eval
