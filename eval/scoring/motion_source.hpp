// Motions on their way to a recogniser, batch by batch, wherever they come from: a motions file, a dataset's split, a
// generator.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ingest/dataset/body_model.hpp"
#include "kernels/device.hpp"

namespace actformer::eval {

/// What is known of the motions before they come.
struct MotionsInfo {
    std::string source;                                    ///< a file or a folder, for messages
    std::optional<ingest::Representation> representation;  ///< none where it is not known
    std::vector<std::string> names;                        ///< (n)
    std::vector<std::uint32_t> labels;                     ///< (n), or empty where they are not known
    std::vector<std::string> classes;         ///< that the labels count, or empty where they are not known
    std::uint32_t channels = 0, joints = 0;   ///< of every motion; channels of all persons together
    std::uint32_t persons = 0;                ///< 0 where it is not known
    std::vector<int> parents;                 ///< (K), or empty where they are not known
    std::uint32_t shortest = 0, longest = 0;  ///< frames
    std::string fingerprint;                  ///< of the file or of the dataset
    bool are_windows = false;                 ///< of clips, each named CLIP@FIRST_FRAME
    std::string view;                         ///< what is shown of each clip, as in "whole motions"
    std::optional<ingest::BodyModel> body;    ///< that gives joint positions, where it is known
};

/// Some motions of one length.
struct MotionBatch {
    std::vector<std::uint64_t> rows;  ///< their places among MotionsInfo::names; none: there are no more
    std::uint32_t frames = 0;
    std::span<const float> values;          ///< (rows, channels, frames, K), good until the next batch
    const cl::Buffer* on_device = nullptr;  ///< the same on the recogniser's device, in place of `values`
};

class MotionSource {
  public:
    virtual ~MotionSource() = default;
    virtual const MotionsInfo& info() const = 0;

    /// Motions that have not come yet; every motion comes once, in any order. Throws Error as the source says.
    virtual MotionBatch next() = 0;
};

/// A set of generated motions that is scored once.
struct MotionSet {
    std::string name;                                     ///< for messages and the provenance
    std::string key;                                      ///< of all that decides the motions
    std::optional<std::uint64_t> seed;                    ///< where it is known
    std::function<std::unique_ptr<MotionSource>()> open;  ///< from the first motion on; quick
};

/// Motions that a generator is asked for.
struct GeneratedRequest {
    std::string generator;              ///< folder of a training, or weights
    std::vector<std::uint32_t> labels;  ///< from 0; empty: all classes
    std::vector<std::uint32_t> counts;  ///< motions of each of `labels`; empty: per_class of all
    std::uint32_t per_class = 100;
    std::uint64_t seed = 0;  ///< of the first set; the next take the seeds that follow
    std::size_t sets = 1;
    std::uint32_t frames = 0;  ///< of every motion's beginning; 0: all
    std::string device;        ///< of libtorch; empty: cpu
};

/// Makes those sets. model/ implements it; scoring knows no generators.
using GenerateSets = std::function<std::vector<MotionSet>(const GeneratedRequest&)>;

}  // namespace actformer::eval
