// Motions measured on their way to a recogniser (eval/metrics/motion_measures.hpp), and such measures on disk.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "eval/metrics/motion_measures.hpp"
#include "eval/scoring/motion_source.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::eval {

/// How motions of a dataset are measured.
struct MeasuringTape {
    ingest::BodyModel
        body;  ///< with mean bone lengths: real and generated motions are measured with the same
    MeasuredBody measured;
    std::uint32_t persons = 1;
};

/// The axis along which bodies stand is that of up to 50 clips. None where joint positions cannot be had, as of rotations without
/// a rest skeleton.
std::optional<MeasuringTape> tape_for(const ingest::Dataset& dataset);

/// Whether motions have the nodes and persons that the tape measures.
bool fits(const MeasuringTape& tape, const MotionsInfo& motions);

/// Motions of another source, measured as they pass. Both outlive it.
class MeasuredSource final : public MotionSource {
  public:
    /// Motions that fit the tape; those on the device are read back through `device`.
    MeasuredSource(std::unique_ptr<MotionSource> from, const MeasuringTape& tape, kernels::Device& device);

    const MotionsInfo& info() const override { return from_->info(); }
    MotionBatch next() override;

    /// In the order of MotionsInfo::names, when all have passed.
    MotionMeasures measures() const;

  private:
    std::unique_ptr<MotionSource> from_;
    const MeasuringTape& tape_;
    kernels::Device& device_;
    std::vector<float> read_back_;
    std::vector<std::uint64_t> rows_;  ///< as they passed
    MotionMeasures passed_;
};

void write_measures(const std::filesystem::path& path, const MotionMeasures& measures);
MotionMeasures read_measures(const std::filesystem::path& path);

}  // namespace actformer::eval
