// The recogniser's layers on processors, forward and backward: plain arrays in, plain arrays out, T float or double.
//
// Motions are (N, T, K, C), channels last: every convolution is a product over rows (row_products.hpp), and a joint's
// channels are whole vectors. The graph's sums run over its few edges in place of a dense (3, K, K) product, and on to
// the 1x1 convolution while the frames are in the cache. All results depend on the number of threads, not on their timing.
#pragma once

#include <cstdint>
#include <span>

namespace actformer::model::cpu {

/// The target joint's sum of part `part` takes in the source joint.
struct Edge {
    std::int32_t part, source, target;
};

struct MotionShape {
    std::int64_t samples, frames, joints;
    std::int64_t rows() const { return samples * frames * joints; }
};

/// y (N,T,K,out) = sum over edges of strength * x, times the part's weight, plus the joint's bias. x (N,T,K,in), strength
/// (edges), weight (3*in, out), bias (K, out); out a multiple of 16.
template <typename T>
void graph_forward(const MotionShape& shape, std::span<const Edge> edges, const T* strength, const T* x,
                   std::int64_t in, const T* weight, const T* bias, std::int64_t out, T* y, int threads);

template <typename T>
struct GraphGradients {
    T *x, *strength, *weight, *bias;  ///< shaped as the arguments, overwritten
};

template <typename T>
void graph_backward(const MotionShape& shape, std::span<const Edge> edges, const T* strength, const T* x,
                    std::int64_t in, const T* weight, std::int64_t out, const T* grad,
                    const GraphGradients<T>& to, int threads);

/// y (N, ceil(T/stride), K, out): a convolution over frames of odd length `taps`, edges padded with zeros. weight
/// (taps, in, out), bias (out); in and out multiples of 16.
struct TemporalShape {
    MotionShape input;
    std::int64_t in, out, taps, stride;
    std::int64_t out_frames() const { return (input.frames + stride - 1) / stride; }
};

template <typename T>
void temporal_forward(const TemporalShape& shape, const T* x, const T* weight, const T* bias, T* y,
                      int threads);

template <typename T>
void temporal_backward(const TemporalShape& shape, const T* x, const T* weight, const T* grad, T* grad_x,
                       T* grad_weight, T* grad_bias, int threads);

/// Mean and biased variance of every channel of x (rows, channels).
template <typename T>
void statistics(const T* x, std::int64_t rows, std::int64_t channels, T* mean, T* variance, int threads);

/// Normalisation and what follows it: y = relu(dropout(normalised x) + shortcut), each of the three only where asked for.
struct NormOptions {
    bool relu = true;
    double drop = 0;         ///< share dropped; the kept are scaled up to make good
    std::uint64_t seed = 0;  ///< decides which
};

template <typename T>
struct Norm {
    const T *mean, *deviation_inverse, *weight, *bias;  ///< (channels)
};

/// `shortcut` may be null.
template <typename T>
void norm_forward(const T* x, std::int64_t rows, std::int64_t channels, const Norm<T>& norm,
                  const NormOptions& options, const T* shortcut, T* y, int threads);

/// Gradients through the batch's own statistics. `grad_shortcut` may be null.
template <typename T>
void norm_backward(const T* x, std::int64_t rows, std::int64_t channels, const Norm<T>& norm,
                   const NormOptions& options, const T* y, const T* grad, T* grad_x, T* grad_shortcut,
                   T* grad_weight, T* grad_bias, int threads);

}  // namespace actformer::model::cpu
