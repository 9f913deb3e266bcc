// NTU RGB+D for the ingest pipeline: two datasets, `ntu-1p` and `ntu-2p`.
#pragma once

#include <unordered_set>

#include "ingest/formats/format.hpp"
#include "ingest/formats/ntu/bodies.hpp"

namespace actformer::ingest {

struct NtuOptions {
    std::unordered_set<std::string> missing;  ///< names of clips to leave out
    BodyRule bodies = BodyRule::frames;
    bool join_tracks = false;  ///< tracks that follow one another in time and place are one body
    kernels::Smoothing smoothing;
};

class NtuFormat : public Format {
  public:
    explicit NtuFormat(NtuOptions options = {});

    std::vector<std::string_view> extensions() const override { return {".skeleton"}; }
    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    std::string settings() const override;
    std::optional<Rejection> refuse(const RawText& raw) const override;
    void read(const RawText& raw, ClipSink& sink) const override;
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

  private:
    ParsedClip parse(const RawText& raw) const;

    /// Keeps the clip's persons of what the file shows, and says what is doubtful about them. False where it shows too few.
    bool choose_bodies(SkeletonFile& file, std::size_t persons, std::vector<std::string>& doubts) const;

    NtuOptions options_;
    std::vector<DatasetHeader> datasets_;
};

/// The published protocols as splits: cross-subject (xsub), cross-view (xview) and cross-setup (xset), train and test.
std::vector<Split> ntu_splits();

}  // namespace actformer::ingest
