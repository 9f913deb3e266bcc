// The recogniser at work: motions to features and logits on an OpenCL device.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "eval/stgcn/weights.hpp"
#include "kernels/stgcn.hpp"

namespace actformer::eval {

/// The steps of a layer, for timing.
enum class Step { enter, gather, graph, split, temporal, join, residual, pool };

struct Recognised {
    std::vector<float> features;  ///< (sequences, Weights::features())
    std::vector<float> logits;    ///< (sequences, classes)
};

/// Calls may come from one thread at a time.
class Recogniser {
  public:
    /// `device` must outlive the recogniser.
    Recogniser(kernels::Device& device, const Weights& weights, const kernels::Tiles& tiles);
    ~Recogniser();

    /// motions (sequences, channels, frames, K) as they are, batch norm included. Any number of sequences of any number of
    /// frames, at least 1: tiles().sequences of them go through together, or fewer where the device's memory asks for it.
    /// The same motion gives the same numbers whatever else is in the batch. Throws Error for a span of another size, and
    /// OutOfMemory where not even one sequence fits.
    Recognised recognise(std::span<const float> motions, std::uint32_t sequences, std::uint32_t frames);

    /// The same with motions that lie on the device.
    Recognised recognise(const cl::Buffer& motions, std::uint32_t sequences, std::uint32_t frames);

    /// Calls `probe` after each step has been enqueued; an empty one is not called.
    void watch(std::function<void(std::size_t layer, Step step)> probe);

    const kernels::Tiles& tiles() const;
    std::uint32_t channels() const;
    std::uint32_t joints() const;
    std::uint32_t features() const;
    std::uint32_t classes() const;

  private:
    struct Network;
    std::unique_ptr<Network> network_;
};

/// Multiplications and additions that the network's definition asks for a sequence (direct convolutions, the graph
/// multiplied as a dense matrix counts nothing), in floating-point operations.
double direct_operations(const StgcnShape& shape, std::uint32_t frames);

/// Those that the multiplies here do: minimal filtering and empty neighbourhoods taken into account.
double multiplied_operations(const StgcnShape& shape, std::uint32_t frames);

}  // namespace actformer::eval
