// Gated recurrent units (Cho et al. 2014) on a device.
#pragma once

#include <cstdint>

#include "kernels/buffer.hpp"
#include "kernels/sampler.hpp"

namespace actformer::kernels {

/// Motions (N, channels, T, nodes), of `numbers` a node and person.
struct MotionLayout {
    std::uint32_t channels = 0, frames = 0, nodes = 0, numbers = 3;

    std::uint32_t inputs() const { return channels * nodes; }
};

/// A layer's weights: input (inputs, 3*hidden) and state (hidden, 3*hidden), the gates r, z, n side by side; bias (6*hidden), the
/// input's first.
struct GruWeights {
    Buffer<float> input, state, bias;
};

/// The kernels, built for one device and one width of the state, a multiple of 16 up to 256. Every call enqueues and returns at once.
class Gru {
  public:
    Gru(Device& device, std::uint32_t hidden);

    /// Sequences begin .. begin + count - 1 of `motion` to poses (count, T, inputs), a node's channels side by side. What the root's
    /// first frame says, the mean over the persons, is taken from what moves with it.
    void poses(const cl::Buffer& motion, const MotionLayout& layout, const Centring& moved,
               std::uint32_t begin, std::uint32_t count, const Buffer<float>& to);

    /// x (count, T, inputs), initial (count, hidden) -> states (count, T, hidden).
    void layer(const Buffer<float>& x, const Buffer<float>& initial, const GruWeights& weights,
               std::uint32_t count, std::uint32_t frames, std::uint32_t inputs, const Buffer<float>& states);

    /// Rows of `inputs` numbers, `pitch` apart from `start` on in x, through weight (outputs, inputs) and bias (outputs) to rows first
    /// and on of `to`; with `squash` a tanh is put behind.
    struct Rows {
        std::uint32_t count, inputs, start, pitch, first;
    };
    void dense(const Buffer<float>& x, const Rows& rows, const Buffer<float>& weight,
               const Buffer<float>& bias, bool squash, const Buffer<float>& to);

  private:
    Device* device_;
    std::uint32_t items_;
    cl::Kernel poses_, layer_, dense_;
};

}  // namespace actformer::kernels
