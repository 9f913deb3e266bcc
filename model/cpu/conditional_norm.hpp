// Conditional batch normalisation and its LeakyReLU on processors, forward and backward. T float or double.
//
// Motions are (samples, nodes, frames, channels) as for graph convolutions (node_kernels.hpp). Every channel is normalised over
// samples, nodes and frames; gain and shift are a sample's own, as its class has them.
#pragma once

#include <cstdint>

namespace actformer::model::cpu {

struct ConditionalNormShape {
    std::int64_t samples = 0, nodes = 0, frames = 0, channels = 0;
    std::int64_t padding = 0;      ///< frames on either side of x, passed over
    std::int64_t out_padding = 0;  ///< zeros on either side of y's frames

    std::int64_t node_in() const { return (frames + 2 * padding) * channels; }
    std::int64_t node_out() const { return (frames + 2 * out_padding) * channels; }
    std::int64_t numbers_a_channel() const { return samples * nodes * frames; }
};

/// Mean and biased variance (channels) of x (samples, nodes, padded frames, channels).
template <typename T>
void conditional_statistics(const ConditionalNormShape& shape, const T* x, T* mean, T* variance, int threads);

/// What x is normalised with.
template <typename T>
struct ConditionalNorm {
    const T *mean, *inverse;  ///< (channels); the inverse of the deviation
    const T *gain, *shift;    ///< (samples, channels)
    T leak;                   ///< by which negative numbers are multiplied
};

/// y (samples, nodes, frames with zeros on either side, channels) = leaky((x - mean) * inverse * gain + shift)
template <typename T>
void conditional_norm_forward(const ConditionalNormShape& shape, const T* x, const ConditionalNorm<T>& norm,
                              T* y, int threads);

/// Gradients through the batch's own statistics, shaped as x, (samples, channels) and (samples, channels).
template <typename T>
struct ConditionalNormGradients {
    T *x, *gain, *shift;
};

template <typename T>
void conditional_norm_backward(const ConditionalNormShape& shape, const T* x, const ConditionalNorm<T>& norm,
                               const T* grad, const ConditionalNormGradients<T>& to, int threads);

}  // namespace actformer::model::cpu
