// Processes that train one model together: libtorch's process groups, Gloo on the processor and NCCL on NVIDIA's GPUs.
// Includes ATen headers, and c10d's only in its source.
#pragma once

#include <ATen/ATen.h>

#include <memory>

#include "base/error.hpp"
#include "model/train/place.hpp"

namespace actformer::model {

/// Another process has ended or cannot be reached.
class PeerLost : public Error {
  public:
    using Error::Error;
};

class Processes {
  public:
    /// One process alone: averages and copies change nothing.
    Processes();

    /// Waits until all have come. Throws Error where they cannot meet, or this build has no way to connect them on
    /// `device`.
    Processes(Place place, const at::Device& device);
    ~Processes();

    const Place& place() const { return place_; }

    /// The mean over all processes of what each has in `values`, in place, the same bits in each. Throws PeerLost.
    void all_reduce_mean(at::Tensor values) const;

    /// What rank 0 has in `values`, in each. Throws PeerLost.
    void broadcast(at::Tensor values) const;

  private:
    struct Group;
    Place place_;
    std::unique_ptr<Group> group_;  ///< none of one alone
};

}  // namespace actformer::model
