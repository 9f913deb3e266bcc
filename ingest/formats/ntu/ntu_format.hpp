// NTU RGB+D for the ingest pipeline: two datasets, `ntu-1p` and `ntu-2p`; or .skeleton files of other names, one dataset.
#pragma once

#include <unordered_set>

#include "ingest/formats/format.hpp"
#include "ingest/formats/ntu/bodies.hpp"
#include "ingest/formats/ntu/own_names.hpp"
#include "ingest/formats/ntu/skeleton_file.hpp"

namespace actformer::ingest {

struct NtuOptions {
    std::unordered_set<std::string> missing;  ///< names of clips to leave out
    BodyRule bodies = BodyRule::frames;
    bool join_tracks = false;  ///< tracks that follow one another in time and place are one body
    kernels::Smoothing smoothing;
    std::optional<OwnNamesOptions> own;  ///< none: the files are named as NTU's
};

class NtuFormat : public Format {
  public:
    /// Throws Error where an option makes no sense.
    explicit NtuFormat(NtuOptions options = {});

    std::vector<std::string_view> extensions() const override { return {".skeleton"}; }
    Survey surveys() const override { return own_ ? Survey::names : Survey::nothing; }
    void survey(const RawText& raw) override { own_->note(raw); }
    void settle() override;
    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    bool drops_empty_classes() const override { return own_.has_value(); }
    std::vector<std::string> remarks() const override;
    std::string settings() const override;
    std::optional<Rejection> refuse(const RawText& raw) const override;
    void read(const RawText& raw, ClipSink& sink) const override;
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

  private:
    /// A clip of a file, as its name tells before the file is read.
    struct Planned {
        std::size_t dataset = 0;
        std::string name;
        std::uint32_t label = 0;
        std::vector<std::string> fields;
        std::optional<std::uint32_t> start, end;  ///< frames of the file, where it holds more than the clip
    };
    std::variant<std::vector<Planned>, Rejection> clips_of(const RawText& raw) const;
    std::variant<std::vector<Planned>, Rejection> named_clips_of(const RawText& raw) const;
    ParsedClip make_clip(Planned planned, SkeletonFile file) const;

    /// Keeps the clip's persons of what the file shows, and says what is doubtful about them. False where it shows too few.
    bool choose_bodies(SkeletonFile& file, std::size_t persons, std::vector<std::string>& doubts) const;

    NtuOptions options_;
    std::optional<OwnNames> own_;
    std::vector<DatasetHeader> datasets_;
};

/// The published protocols as splits: cross-subject (xsub), cross-view (xview) and cross-setup (xset), train and test.
std::vector<Split> ntu_splits();

}  // namespace actformer::ingest
