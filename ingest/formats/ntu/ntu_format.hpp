// NTU RGB+D for the ingest pipeline: two datasets, `ntu-1p` and `ntu-2p`.
#pragma once

#include "ingest/formats/format.hpp"

namespace actformer::ingest {

class NtuFormat : public Format {
  public:
    explicit NtuFormat(kernels::Smoothing smoothing = {});

    std::string_view extension() const override { return ".skeleton"; }
    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    std::string settings() const override;
    ParsedClip parse(const RawText& raw) const override;
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

  private:
    kernels::Smoothing smoothing_;
    std::vector<DatasetHeader> datasets_;
};

/// The protocols of DESIGN 4.1 as splits: xsub, xview and xset, train and test.
std::vector<Split> ntu_splits();

}  // namespace actformer::ingest
