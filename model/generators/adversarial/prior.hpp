// The prior's latents, Gaussian processes over frames. A latent is a function of seed, index and
// place alone, whatever the device, the threads or the batch. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <cstdint>
#include <map>
#include <mutex>

#include "model/generators/adversarial/prior_settings.hpp"

namespace actformer::model {

class Prior {
  public:
    Prior(const PriorSettings& settings, std::uint64_t seed);

    const PriorSettings& settings() const { return settings_; }

    /// Latents (count, streams, frames, channels), float32 on the processor. Sample i of draw `index` is the same in every
    /// batch: a process that takes a part of a batch says where it starts in `first_sample`. Indices below 2^56; give D and G
    /// steps different ones.
    at::Tensor draw(std::uint64_t index, std::int64_t count, std::int64_t frames,
                    std::uint64_t first_sample = 0) const;

    /// What a draw makes of normal numbers (count, streams, frames, channels): Gaussian processes over the frames.
    at::Tensor correlated(const at::Tensor& normals) const;

    /// The covariance of channel `channel` over `frames` frames, (frames, frames) in double.
    static at::Tensor covariance(const PriorSettings& settings, std::int64_t channel, std::int64_t frames);

  private:
    at::Tensor factors(std::int64_t frames) const;

    PriorSettings settings_;
    std::uint64_t seed_;
    mutable std::mutex mutex_;
    mutable std::map<std::int64_t, at::Tensor>
        factors_;  ///< by frames: (frames, frames, channels), roots of the covariances
};

}  // namespace actformer::model
