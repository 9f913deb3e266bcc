// A split of a dataset on a device, ready to be sampled.
#pragma once

#include <functional>
#include <string>

#include "ingest/dataset/dataset.hpp"
#include "kernels/sampler.hpp"

namespace actformer::ingest {

/// Clips of a split: clip i of the store is dataset.clips()[clips[i]].
struct View {
    std::vector<std::size_t> clips;
    kernels::ClipStore store;
};

/// Indices into dataset.clips() of those in `split`. Throws Error for a split that does not exist or holds no clip.
std::vector<std::size_t> clips_in(const Dataset& dataset, const std::string& split);

/// Reads the clips of `split` ("all" for every clip) onto the device, calling `progress(clips read, of how many)` now and
/// then. Throws Error for a split that does not exist or holds no clip, and for more frames than the device takes.
View load_view(kernels::Device& device, const Dataset& dataset, const std::string& split,
               const std::function<void(std::size_t, std::size_t)>& progress = {});

}  // namespace actformer::ingest
