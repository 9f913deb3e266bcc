// The layers of the spatial-temporal graph convolutional network (ST-GCN, Yan et al. 2018) on a device.
//
// Activations lie in panels, one a joint: row n * T + t holds the channels of frame t of sequence n. Channels are padded
// with zeros to a multiple of Tiles::block() and rows to a multiple of Tiles::rows, so that every step runs in whole vectors.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "kernels/buffer.hpp"
#include "kernels/tiles.hpp"

namespace actformer::kernels {

/// A view of (panels, rows, pitch) numbers in some memory.
struct Panels {
    cl::Buffer memory;
    std::uint32_t count = 0, rows = 0, pitch = 0;
};

/// Weights of several products, packed for the multiply.
struct PackedWeights {
    Buffer<float> values;                        ///< (sets, columns / block, depth, block)
    std::uint32_t depth = 0, column_blocks = 0;  ///< of every set
};

/// Which panels meet which weights: problem p sums panel * set over segments first[p] .. first[p + 1] - 1. In graph
/// convolutions what is summed by a segment's end is multiplied by its scale.
struct Problems {
    Buffer<std::uint32_t> first, segments;  ///< (count + 1), (segments, 2): panel, set
    Buffer<float> scale;                    ///< (segments)
    std::uint32_t count = 0;
};

/// Sparse mixtures of joints: gathered panel p is the sum of share * source over first[p] .. first[p + 1] - 1.
struct Mixture {
    Buffer<std::uint32_t> first, source;
    Buffer<float> share;
    std::uint32_t count = 0;
};

/// Winograd's transform of a filter of nine taps (temporal.cl), in double: 40 (stride 1) or 16 (stride 2) numbers, in
/// the order that temporal.cl gives them.
std::vector<double> filter_points(std::span<const double, 9> taps, std::uint32_t stride);

/// Frames that one tile of the temporal convolution gives, and its points as inputs and as results of the multiply.
struct Filtering {
    std::uint32_t tile, points_in, points_out;
};
constexpr Filtering filtering(std::uint32_t stride) {
    return stride == 1 ? Filtering{18, 40, 40} : Filtering{4, 16, 8};
}

/// Frames that `frames` become at `stride` (9 taps, padding 4).
constexpr std::uint32_t strided(std::uint32_t frames, std::uint32_t stride) {
    return (frames - 1) / stride + 1;
}

/// The kernels, built for one device and one choice of tiles. Every call enqueues and returns at once.
class Stgcn {
  public:
    /// Throws Error where filters would reach beyond a row: tiles.filter_vec must divide a block.
    Stgcn(Device& device, const Tiles& tiles);

    Device& device() const { return *device_; }
    const Tiles& tiles() const { return tiles_; }
    std::uint32_t pitch(std::uint32_t channels) const;  ///< channels padded
    std::uint32_t rows(std::size_t rows) const;         ///< rows padded

    /// `values` (sets, depth, columns).
    PackedWeights pack(std::span<const float> values, std::uint32_t sets, std::uint32_t depth,
                       std::uint32_t columns) const;

    /// Sequences begin .. begin + sequences - 1 of motion (N, C, T, K) to panels (K, sequences * T, pitch of C), scaled and
    /// shifted a (joint, channel): both are (K * C).
    void enter(const cl::Buffer& motion, const Buffer<float>& scale, const Buffer<float>& shift,
               const Panels& to, std::uint32_t begin, std::uint32_t sequences, std::uint32_t channels,
               std::uint32_t frames);

    /// Mixes joints to the panels of `to` behind its first `behind`; keeps every stride-th of `frames` frames.
    void gather(const Panels& from, const Mixture& mixture, const Panels& to, std::uint32_t behind,
                std::uint32_t sequences, std::uint32_t frames, std::uint32_t stride);

    /// The packed multiply over the first `rows` rows.
    void multiply(const Panels& from, const PackedWeights& weights, const Problems& problems,
                  const Panels& to, std::size_t rows);

    /// The same with the segments' scales; then the bias (problems, pitch) is added and negatives become 0.
    void multiply_graph(const Panels& from, const PackedWeights& weights, const Problems& problems,
                        const Buffer<float>& bias, const Panels& to, std::size_t rows);

    /// Frames to the points of the temporal convolution.
    void transform_input(const Panels& from, const Panels& to, std::uint32_t sequences, std::uint32_t frames,
                         std::uint32_t stride);

    /// Points to frames, `frames` of them a sequence after the stride; adds the bias (pitch) and the residual, where there is
    /// one; negatives become 0.
    void transform_output(const Panels& from, const Buffer<float>& bias, const Panels* residual,
                          const Panels& to, std::uint32_t sequences, std::uint32_t frames,
                          std::uint32_t stride);

    /// Means over frames and joints to features (N, channels), from sequence `begin` on.
    void pool(const Panels& from, const Buffer<float>& features, std::uint32_t begin, std::uint32_t sequences,
              std::uint32_t channels, std::uint32_t frames);

    /// features (N, channels) to logits (N, classes); weights (classes, channels).
    void classify(const Buffer<float>& features, const Buffer<float>& weights, const Buffer<float>& bias,
                  const Buffer<float>& logits, std::uint32_t sequences, std::uint32_t channels,
                  std::uint32_t classes);

  private:
    cl::Kernel product(bool graph, std::uint32_t a_pitch, std::uint32_t out_pitch);
    void multiply(cl::Kernel kernel, const Panels& from, const PackedWeights& weights,
                  const Problems& problems, const Buffer<float>& bias, const Panels& to, std::size_t rows);
    std::size_t channel_items(std::uint32_t pitch, std::uint32_t vec) const;

    Device* device_;
    Tiles tiles_;
    cl::Kernel enter_, gather_, pool_, classify_, transform_input_, transform_output_;
    std::map<std::array<std::uint32_t, 3>, cl::Kernel> products_;  ///< by (graph, pitch of a, pitch of out)
};

}  // namespace actformer::kernels
