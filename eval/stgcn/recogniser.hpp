// The ST-GCN on an OpenCL device.
#pragma once

#include <functional>

#include "eval/recogniser.hpp"
#include "eval/stgcn/weights.hpp"
#include "kernels/tiles.hpp"

namespace actformer::eval {

/// The steps of a layer, for timing.
enum class Step { enter, gather, graph, transform_input, temporal, transform_output, residual, pool };

/// tiles().sequences sequences go through the network together, or fewer where the device's memory asks for it.
class StgcnRecogniser final : public Recogniser {
  public:
    StgcnRecogniser(kernels::Device& device, const StgcnWeights& weights, const kernels::Tiles& tiles);
    ~StgcnRecogniser() override;

    using Recogniser::recognise;
    Recognised recognise(const cl::Buffer& motions, std::uint32_t sequences, std::uint32_t frames) override;

    /// Calls `probe` after each step has been enqueued; an empty one is not called.
    void watch(std::function<void(std::size_t layer, Step step)> probe);

    const kernels::Tiles& tiles() const;

  private:
    struct Network;
    std::unique_ptr<Network> network_;
};

/// As open_recogniser() does, with the tiles kept for this device.
std::unique_ptr<Recogniser> open_stgcn(kernels::Device& device, const std::filesystem::path& weights,
                                       std::uint32_t batch);

}  // namespace actformer::eval
