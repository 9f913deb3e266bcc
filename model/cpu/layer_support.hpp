// Linear layers and layer normalisations in the kernels: packed weights, rows forward and backward, threads' sums of gradients.
#pragma once

#include <cmath>

#include "model/cpu/kernel_support.hpp"
#include "model/cpu/transformer_kernels.hpp"

namespace actformer::model::cpu {

/// What scratch memory is for.
namespace layer_memory {
struct OuterPanel {};
template <typename Purpose>
struct BiasOf {};
}  // namespace layer_memory

/// A linear layer for rows of inputs: its weight, and its bias with zeros behind for loads of whole panels.
template <typename T>
struct PackedLinear {
    const PackedMatrix<T>& weight;
    const T* bias;
};

/// In the calling thread's memory for `purpose`.
template <typename T, typename Purpose>
PackedLinear<T> packed_forward(Purpose purpose, const LinearWeight<T>& linear, std::int64_t out,
                               std::int64_t in, int threads) {
    auto& weight = packed_scratch<T>(purpose);
    pack_forward(weight, linear.weight, out, in, threads);
    return {weight, padded_copy(purpose, linear.bias, out)};
}

/// The weight for rows of outputs' gradients, in the calling thread's memory for `purpose`.
template <typename T, typename Purpose>
const PackedMatrix<T>& packed_backward(Purpose purpose, const LinearWeight<T>& linear, std::int64_t out,
                                       std::int64_t in, int threads) {
    auto& weight = packed_scratch<T>(purpose);
    pack_backward(weight, linear.weight, out, in, threads);
    return weight;
}

/// Threads' own sums of a linear layer's gradients.
template <typename T>
class LinearSums {
  public:
    LinearSums(int threads, std::int64_t out, std::int64_t in)
        : out_(out), in_(in), weight_(threads, out, in), bias_(threads, 1, out) {}

    /// A thread's.
    struct Own {
        ParameterGradient<T> sums;
        std::int64_t out, in, pitch;

        /// Adds what `rows` rows of outputs' gradients and of inputs come to.
        void add(const EvenRows<T>& grad, const EvenRows<T>& inputs, std::int64_t rows) const {
            for (std::int64_t r = 0; r < rows; ++r) add_row(grad.first + r * grad.pitch, out, sums.bias);
            add_outer_products<T>(
                grad.first, grad.pitch, out, [&](std::int64_t r) { return inputs.first + r * inputs.pitch; },
                in, rows, scratch<T>(layer_memory::OuterPanel{}, rows * panel_columns<T>), sums.weight,
                pitch);
        }
    };

    /// Called by every thread of a team before it adds.
    template <typename Purpose>
    Own own(Purpose purpose) {
        return {
            {weight_.own(purpose), bias_.own(layer_memory::BiasOf<Purpose>{})}, out_, in_, weight_.pitch()};
    }

    /// Called by every thread of a team, behind a barrier.
    void write(const ParameterGradient<T>& to) const {
        weight_.write(to.weight);
        bias_.write(to.bias);
    }

  private:
    std::int64_t out_, in_;
    ThreadSums<T> weight_, bias_;
};

/// Threads' own sums of a normalisation's gradients; called as LinearSums.
template <typename T>
class NormSums {
  public:
    NormSums(int threads, std::int64_t width) : weight_(threads, 1, width), bias_(threads, 1, width) {}

    template <typename Purpose>
    ParameterGradient<T> own(Purpose purpose) {
        return {weight_.own(purpose), bias_.own(layer_memory::BiasOf<Purpose>{})};
    }

    void write(const ParameterGradient<T>& to) const {
        weight_.write(to.weight);
        bias_.write(to.bias);
    }

  private:
    ThreadSums<T> weight_, bias_;
};

constexpr double layer_norm_epsilon = 1e-6;

/// A row's mean and one over its deviation.
template <typename T>
struct RowStatistics {
    T mean, inverse;

    RowStatistics(const T* x, std::int64_t width, double epsilon) {
        T sum = 0, squares = 0;
#pragma omp simd reduction(+ : sum)
        for (std::int64_t c = 0; c < width; ++c) sum += x[c];
        mean = sum / static_cast<T>(width);
        const T m = mean;
#pragma omp simd reduction(+ : squares)
        for (std::int64_t c = 0; c < width; ++c) squares += (x[c] - m) * (x[c] - m);
        inverse = 1 / std::sqrt(squares / static_cast<T>(width) + static_cast<T>(epsilon));
    }
};

template <typename T>
inline void normalise_row(const T* x, std::int64_t width, const NormWeight<T>& norm, T* to,
                          double epsilon = layer_norm_epsilon) {
    const RowStatistics<T> row(x, width, epsilon);
    const T mean = row.mean, inverse = row.inverse;
    const T *weight = norm.weight, *bias = norm.bias;
#pragma omp simd
    for (std::int64_t c = 0; c < width; ++c) to[c] = (x[c] - mean) * inverse * weight[c] + bias[c];
}

/// to = onto + the gradient to x of a normalised row whose gradient is `grad`; `onto` may be null, or `to`. Adds the parameters' to `own`.
template <typename T>
inline void normalise_row_backward(const T* x, const T* grad, std::int64_t width, const T* weight,
                                   const T* onto, T* to, const ParameterGradient<T>& own,
                                   double epsilon = layer_norm_epsilon) {
    const RowStatistics<T> row(x, width, epsilon);
    const T mean = row.mean, inverse = row.inverse;
    T *grad_weight = own.weight, *grad_bias = own.bias;
    T sum = 0, along = 0;
#pragma omp simd reduction(+ : sum, along)
    for (std::int64_t c = 0; c < width; ++c) {
        const T normal = (x[c] - mean) * inverse, g = grad[c] * weight[c];
        grad_weight[c] += grad[c] * normal;
        grad_bias[c] += grad[c];
        sum += g;
        along += g * normal;
    }
    sum /= static_cast<T>(width);
    along /= static_cast<T>(width);
#pragma omp simd
    for (std::int64_t c = 0; c < width; ++c) {
        const T normal = (x[c] - mean) * inverse;
        const T g = inverse * (grad[c] * weight[c] - sum - normal * along);
        to[c] = onto ? onto[c] + g : g;
    }
}

/// x (rows, width) -> to (rows, pitch).
template <typename T>
void normalise_rows(const T* x, std::int64_t rows, std::int64_t width, const NormWeight<T>& norm, T* to,
                    std::int64_t pitch) {
    for (std::int64_t r = 0; r < rows; ++r) normalise_row(x + r * width, width, norm, to + r * pitch);
}

/// grad (rows, pitch); x, onto, which may be null, and to (rows, width).
template <typename T>
void normalise_rows_backward(const T* x, const T* grad, std::int64_t pitch, std::int64_t rows,
                             std::int64_t width, const NormWeight<T>& norm, const T* onto, T* to,
                             const ParameterGradient<T>& own) {
    for (std::int64_t r = 0; r < rows; ++r)
        normalise_row_backward<T>(x + r * width, grad + r * pitch, width, norm.weight,
                                  onto ? onto + r * width : nullptr, to + r * width, own);
}

}  // namespace actformer::model::cpu
