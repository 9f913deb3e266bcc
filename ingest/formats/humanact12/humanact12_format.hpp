// HumanAct12 (Guo et al. 2020) in both forms: joints, a .npy a clip, as Action2Motion published it; and SMPL's rotations of all clips
// in humanact12poses.pkl, as ACTOR (Petrovich et al. 2021) did.
#pragma once

#include <string>
#include <vector>

#include "ingest/formats/format.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"
#include "ingest/formats/skeletal/up.hpp"

namespace actformer::ingest {

struct HumanAct12Options {
    enum class From { files, rotations, joints };  ///< files: rotations where there is a pickle, else joints
    std::string dataset;                           ///< the dataset's name
    From from = From::files;
    RotationalTarget
        target;  ///< of rotations; joints become limbs, or positions where its representation is xyz
    double fps = 30;
    bool published = false;  ///< the camera's frame with y down, as the public tools leave it
};

/// One dataset of 12 classes without splits, as published.
class HumanAct12Format : public Format {
  public:
    explicit HumanAct12Format(HumanAct12Options options) : options_(std::move(options)) {}

    std::vector<std::string_view> extensions() const override { return {".npy", ".pkl"}; }
    std::uint64_t largest_file() const override { return std::uint64_t{8} << 30; }
    Survey surveys() const override { return Survey::names; }
    void survey(const RawText& raw) override { ++(raw.ends_in(".pkl") ? pickles_ : arrays_); }
    void settle() override;
    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    std::string settings() const override;
    std::vector<std::string> remarks() const override;
    std::optional<Rejection> refuse(const RawText& raw) const override;
    void read(const RawText& raw, ClipSink& sink) const override;
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

  private:
    void read_pickle(const RawText& raw, ClipSink& sink) const;
    class Clips;

    Up up() const { return options_.published ? Up::y : Up::minus_y; }
    ParsedClip make_clip(const Clips& clips, std::size_t i) const;
    ParsedClip parse_array(const RawText& raw) const;

    HumanAct12Options options_;
    std::vector<DatasetHeader> datasets_;
    std::size_t pickles_ = 0, arrays_ = 0;
    bool settled_ = false;
    bool rotations_ = false;   ///< and not joints
    bool from_arrays_ = true;  ///< joints of the .npy files, and not of the pickle
};

}  // namespace actformer::ingest
