// Scores of a generator while it trains, from a recogniser in OpenCL: its motions beside the real windows of the same split.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/dataset.hpp"
#include "kernels/sampler.hpp"

namespace actformer::model {

/// Motions of known classes: values (labels.size(), P*D, T, K).
struct Labelled {
    std::vector<float> values;
    std::vector<std::uint32_t> labels;
};

struct ValidationScores {
    double accuracy = 0;             ///< 0..1, the mean over classes of the hit rate
    double fid_whole = 0;            ///< FIDw
    std::optional<double> fid_mean;  ///< FIDm; none where no class has two motions on both sides
};

class ValidationMetrics {
  public:
    /// `recogniser`: weights, or the folder of a training (see eval::weights_of). Takes features of every consecutive window of
    /// `clips`, which are split `split` of `dataset`; where the recogniser sees common joints, the split is read again in those. Throws Error where the recogniser does not fit the dataset.
    ValidationMetrics(const std::filesystem::path& recogniser, const std::string& opencl,
                      const ingest::Dataset& dataset, const std::string& split,
                      const kernels::ClipStore& clips, std::uint32_t frames);
    ~ValidationMetrics();

    double real_accuracy() const;  ///< of the real windows
    std::size_t real_windows() const;
    const std::string& checksum() const;  ///< of the recogniser's weights

    /// From one thread at a time; which one does not matter.
    ValidationScores score(const Labelled& motions);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace actformer::model
