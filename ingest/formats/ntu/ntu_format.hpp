// NTU RGB+D for the ingest pipeline: two datasets, `ntu-1p` and `ntu-2p`.
#pragma once

#include <unordered_set>

#include "ingest/formats/format.hpp"

namespace actformer::ingest {

class NtuFormat : public Format {
  public:
    /// `missing`: names of clips to leave out.
    explicit NtuFormat(std::unordered_set<std::string> missing = {}, kernels::Smoothing smoothing = {});

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

    std::unordered_set<std::string> missing_;
    kernels::Smoothing smoothing_;
    std::vector<DatasetHeader> datasets_;
};

/// The published protocols as splits: cross-subject (xsub), cross-view (xview) and cross-setup (xset), train and test.
std::vector<Split> ntu_splits();

}  // namespace actformer::ingest
