// Motions measured on their way to a recogniser (eval/metrics/motion_measures.hpp), and such measures on disk.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "eval/metrics/motion_measures.hpp"
#include "eval/scoring/motion_source.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::eval {

/// How motions of a dataset are measured.
struct MeasurementSetup {
    ingest::BodyModel
        body;  ///< with mean bone lengths: real and generated motions are measured with the same
    MeasuredBody measured;
    std::uint32_t persons = 1;
};

/// The axis along which bodies stand is that of 50 to 99 clips, or of all where there are fewer. None where joint positions cannot be had, as of rotations without
/// a rest skeleton. Throws Error where a clip is damaged.
std::optional<MeasurementSetup> measurement_setup(const ingest::Dataset& dataset);

/// Whether motions have the nodes and persons that the setup measures.
bool fits(const MeasurementSetup& setup, const MotionsInfo& motions);

/// Motions of another source, which it owns, measured as they pass. The setup and the device must outlive it.
class MeasuredSource final : public MotionSource {
  public:
    /// Motions that fit the setup; those on the device are read back through `device`.
    MeasuredSource(std::unique_ptr<MotionSource> from, const MeasurementSetup& setup,
                   kernels::Device& device);

    const MotionsInfo& info() const override { return from_->info(); }
    MotionBatch next() override;

    /// In the order of MotionsInfo::names, when all have passed.
    MotionMeasures measures() const;

  private:
    std::unique_ptr<MotionSource> from_;
    const MeasurementSetup& setup_;
    kernels::Device& device_;
    std::vector<float> read_back_;
    std::vector<std::uint64_t> rows_;  ///< as they passed
    MotionMeasures passed_;
};

}  // namespace actformer::eval
