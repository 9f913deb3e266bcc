// Windows of a dataset's split on their way to a trainer: drawn on the OpenCL device and read in place, or drawn by the processor.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "kernels/sampler.hpp"

namespace actformer::model {

/// The key `opencl` where no OpenCL shall be used: the processor draws.
inline constexpr std::string_view no_opencl = "none";

/// Windows in host memory, good until the feed moves on.
struct Windows {
    std::uint32_t count = 0;
    const float* values = nullptr;          ///< (count, P*C, T, K)
    const std::uint32_t* labels = nullptr;  ///< (count)
};

/// Random batches, each drawn while the one before is used.
class RandomFeed {
  public:
    RandomFeed(const kernels::ClipStore& clips, const kernels::SamplerOptions& options, std::uint32_t batch,
               std::uint32_t frames);

    /// Batch `index`; quick where it follows the one before.
    Windows batch(std::uint64_t index);

  private:
    kernels::Sampler sampler_;
    kernels::Batch slots_[2];
    std::uint64_t drawn_[2];
};

/// Calls `use` with every consecutive window of the clips, `batch` or fewer at a time.
void for_each_window(const kernels::ClipStore& clips, std::uint32_t batch, std::uint32_t frames,
                     const std::function<void(const Windows&)>& use);

}  // namespace actformer::model
