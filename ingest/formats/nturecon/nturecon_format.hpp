// NTURecon-1P (Xu et al. 2023): SMPL fitted to the videos of NTU RGB+D by several views, a pickle a person with AIST++'s keys
// (Li et al. 2021).
#pragma once

#include <string>
#include <vector>

#include "ingest/formats/format.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"

namespace actformer::ingest {

/// One dataset of the 94 classes with one person, split by performers.
class NtuReconFormat : public Format {
  public:
    NtuReconFormat(const std::string& dataset, RotationalTarget target);

    std::vector<std::string_view> extensions() const override { return {".pkl"}; }
    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    std::string settings() const override { return "nturecon: " + target_.text(); }
    std::optional<Rejection> refuse(const RawText& raw) const override;
    void read(const RawText& raw, ClipSink& sink) const override;
    kernels::CleanedBatch clean(kernels::Device&, std::size_t,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override {
        return gathered(clips, target_, frames);
    }

  private:
    RotationalTarget target_;
    std::vector<DatasetHeader> datasets_;
};

}  // namespace actformer::ingest
