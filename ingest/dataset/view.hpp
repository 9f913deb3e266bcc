// A split of a dataset on a device or in memory, ready to be sampled.
#pragma once

#include <functional>
#include <string>

#include "ingest/dataset/common_joints.hpp"
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

/// How motions of a representation and a skeleton look to those who are shown `joints` of them.
Representation representation_seen(Representation own, Joints joints);
const Topology& topology_seen(const Topology& own, Joints joints);

/// The same of a dataset's motions.
Representation representation_of(const Dataset& dataset, Joints joints);
const Topology& topology_of(const Dataset& dataset, Joints joints);

/// Reads the clips of `split` ("all" for every clip) onto the device. Windows of common joints are centred whatever the dataset says, as
/// generated motions are by CommonJoints. Throws Error for a split that does not exist or holds no
/// clip, for more frames than the device takes, and as CommonJoints does.
View load_view(kernels::Device& device, const Dataset& dataset, const std::string& split,
               Joints joints = Joints::own);

/// The same in memory, for a machine without OpenCL.
View load_view(const Dataset& dataset, const std::string& split, Joints joints = Joints::own);

}  // namespace actformer::ingest
