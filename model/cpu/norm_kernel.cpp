// Batch normalisation together with the dropout, shortcut and ReLU behind it: each number is read and written once.
#include <omp.h>

#include <algorithm>
#include <vector>

#include "model/cpu/layer_kernels.hpp"

namespace actformer::model::cpu {
namespace {

/// Rows that are summed in T before they join the sums in double.
constexpr std::int64_t block_rows = 16;

/// Which numbers are kept: a hash of the place and the seed against a threshold.
class Mask {
  public:
    explicit Mask(const NormOptions& options)
        : low_(static_cast<std::uint32_t>(options.seed)),
          high_(static_cast<std::uint32_t>(options.seed >> 32)),
          threshold_(static_cast<std::uint32_t>(options.drop * 4294967296.0)) {}

    bool keeps(std::uint32_t place) const {
        std::uint32_t h = place * 0x9E3779B1U ^ low_;
        h = (h ^ (h >> 16)) * 0x85EBCA6BU + high_;
        h = (h ^ (h >> 13)) * 0xC2B2AE35U;
        return (h ^ (h >> 16)) >= threshold_;
    }

  private:
    std::uint32_t low_, high_, threshold_;
};

/// Calls body(row, count, sums (2, channels)) for blocks of rows, and adds the sums up in double, thread after thread.
template <typename T, typename Body>
std::vector<double> sums_over_rows(std::int64_t rows, std::int64_t channels, int threads, const Body& body) {
    const auto both = static_cast<std::size_t>(2 * channels);
    std::vector<std::vector<double>> sums(static_cast<std::size_t>(threads));
#pragma omp parallel num_threads(threads)
    {
        auto& own = sums[static_cast<std::size_t>(omp_get_thread_num())];
        own.assign(both, 0);
        std::vector<T> part(both);
#pragma omp for schedule(static)
        for (std::int64_t row = 0; row < rows; row += block_rows) {
            std::fill(part.begin(), part.end(), T(0));
            body(row, std::min(block_rows, rows - row), part.data());
            for (std::size_t i = 0; i < both; ++i) own[i] += static_cast<double>(part[i]);
        }
    }
    std::vector<double> total(both, 0);
    for (const auto& own : sums)
        for (std::size_t i = 0; i < own.size(); ++i) total[i] += own[i];
    return total;
}

template <bool relu, bool drop, bool add, typename T>
void finish_rows(const T* x, std::int64_t rows, std::int64_t channels, const T* mean, const T* scale,
                 const T* bias, const Mask& mask, T gain, const T* shortcut, T* y, int threads) {
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t row = 0; row < rows; ++row) {
        const auto first = row * channels;
        const T* from = x + first;
        T* to = y + first;
#pragma omp simd
        for (std::int64_t c = 0; c < channels; ++c) {
            T v = (from[c] - mean[c]) * scale[c] + bias[c];
            if constexpr (drop) v = mask.keeps(static_cast<std::uint32_t>(first + c)) ? v * gain : T(0);
            if constexpr (add) v += shortcut[first + c];
            if constexpr (relu) v = v < 0 ? T(0) : v;  // NaN stays
            to[c] = v;
        }
    }
}

/// What of a row's gradient reaches its normalised numbers.
template <bool relu, bool drop, typename T>
inline void arriving(const T* grad, const T* y, std::int64_t first, std::int64_t channels, const Mask& mask,
                     T gain, T* to) {
    const T *from = grad + first, *out = y + first;
#pragma omp simd
    for (std::int64_t c = 0; c < channels; ++c) {
        T g = from[c];
        if constexpr (relu) g = out[c] <= 0 ? T(0) : g;
        if constexpr (drop) g = mask.keeps(static_cast<std::uint32_t>(first + c)) ? g * gain : T(0);
        to[c] = g;
    }
}

/// grad_x = factor * (g - constant - (x - mean) * slope)
template <typename T>
struct NormGradient {
    std::vector<T> factor, constant, slope;

    /// `sums` (2, channels): of g, and of g * (x - mean).
    NormGradient(const Norm<T>& norm, const std::vector<double>& sums, std::int64_t rows, T* grad_weight,
                 T* grad_bias)
        : factor(sums.size() / 2), constant(factor.size()), slope(factor.size()) {
        const auto width = factor.size();
        for (std::size_t c = 0; c < width; ++c) {
            const double inverse = static_cast<double>(norm.deviation_inverse[c]),
                         count = static_cast<double>(rows);
            grad_bias[c] = static_cast<T>(sums[c]);
            grad_weight[c] = static_cast<T>(sums[width + c] * inverse);
            factor[c] = static_cast<T>(static_cast<double>(norm.weight[c]) * inverse);
            constant[c] = static_cast<T>(sums[c] / count);
            slope[c] = static_cast<T>(sums[width + c] * inverse * inverse / count);
        }
    }

    void apply(const T* g, const T* x, const T* mean, T* to) const {
        const T *f = factor.data(), *k = constant.data(), *s = slope.data();
        const auto channels = static_cast<std::int64_t>(factor.size());
#pragma omp simd
        for (std::int64_t c = 0; c < channels; ++c) to[c] = f[c] * (g[c] - k[c] - (x[c] - mean[c]) * s[c]);
    }
};

template <bool relu, bool drop, typename T>
void backward_rows(const T* x, std::int64_t rows, std::int64_t channels, const Norm<T>& norm,
                   const Mask& mask, T gain, const T* y, const T* grad, T* grad_x, T* grad_shortcut,
                   T* grad_weight, T* grad_bias, int threads) {
    const auto width = static_cast<std::size_t>(channels);
    const T* mean = norm.mean;
    const auto sums =
        sums_over_rows<T>(rows, channels, threads, [&](std::int64_t row, std::int64_t count, T* part) {
            std::vector<T> buffer(width);
            T *g = buffer.data(), *weighted = part + channels;
            for (std::int64_t r = row; r < row + count; ++r) {
                const T* from = x + r * channels;
                arriving<relu, drop>(grad, y, r * channels, channels, mask, gain, g);
#pragma omp simd
                for (std::int64_t c = 0; c < channels; ++c) {
                    part[c] += g[c];
                    weighted[c] += g[c] * (from[c] - mean[c]);
                }
            }
        });
    const NormGradient<T> gradient(norm, sums, rows, grad_weight, grad_bias);
#pragma omp parallel num_threads(threads)
    {
        std::vector<T> g(width);
#pragma omp for schedule(static)
        for (std::int64_t row = 0; row < rows; ++row) {
            const auto first = row * channels;
            arriving<relu, drop>(grad, y, first, channels, mask, gain, g.data());
            gradient.apply(g.data(), x + first, mean, grad_x + first);
            if (grad_shortcut)
                arriving<relu, false>(grad, y, first, channels, mask, gain, grad_shortcut + first);
        }
    }
}

}  // namespace

template <typename T>
void statistics(const T* x, std::int64_t rows, std::int64_t channels, T* mean, T* variance, int threads) {
    const T* origin =
        x;  // sums of differences from the first row keep a small spread about a large mean exact
    const auto sums =
        sums_over_rows<T>(rows, channels, threads, [=](std::int64_t row, std::int64_t count, T* part) {
            T* squares = part + channels;
            for (std::int64_t r = row; r < row + count; ++r) {
                const T* from = x + r * channels;
#pragma omp simd
                for (std::int64_t c = 0; c < channels; ++c) {
                    const T d = from[c] - origin[c];
                    part[c] += d;
                    squares[c] += d * d;
                }
            }
        });
    const auto count = static_cast<double>(rows);
    for (std::int64_t c = 0; c < channels; ++c) {
        const double shift = sums[static_cast<std::size_t>(c)] / count;
        mean[c] = static_cast<T>(static_cast<double>(origin[c]) + shift);
        const double square = sums[static_cast<std::size_t>(channels + c)] / count - shift * shift;
        variance[c] = static_cast<T>(std::max(square, 0.0));  // in this order NaN stays
    }
}

template <typename T>
void norm_forward(const T* x, std::int64_t rows, std::int64_t channels, const Norm<T>& norm,
                  const NormOptions& options, const T* shortcut, T* y, int threads) {
    // The mean is taken off first: folded into the bias, it would cost a channel far from zero its last digits.
    std::vector<T> scale(static_cast<std::size_t>(channels));
    for (std::size_t c = 0; c < scale.size(); ++c) scale[c] = norm.weight[c] * norm.deviation_inverse[c];
    const Mask mask(options);
    const T gain = static_cast<T>(1 / (1 - options.drop));
    const auto run = [&]<bool relu, bool drop, bool add>() {
        finish_rows<relu, drop, add>(x, rows, channels, norm.mean, scale.data(), norm.bias, mask, gain,
                                     shortcut, y, threads);
    };
    const bool drop = options.drop > 0;
    if (!options.relu)
        return drop ? run.template operator()<false, true, false>()
                    : run.template operator()<false, false, false>();
    if (shortcut)
        return drop ? run.template operator()<true, true, true>()
                    : run.template operator()<true, false, true>();
    return drop ? run.template operator()<true, true, false>()
                : run.template operator()<true, false, false>();
}

template <typename T>
void norm_backward(const T* x, std::int64_t rows, std::int64_t channels, const Norm<T>& norm,
                   const NormOptions& options, const T* y, const T* grad, T* grad_x, T* grad_shortcut,
                   T* grad_weight, T* grad_bias, int threads) {
    const Mask mask(options);
    const T gain = static_cast<T>(1 / (1 - options.drop));
    const auto run = [&]<bool relu, bool drop>() {
        backward_rows<relu, drop>(x, rows, channels, norm, mask, gain, y, grad, grad_x, grad_shortcut,
                                  grad_weight, grad_bias, threads);
    };
    if (options.relu)
        return options.drop > 0 ? run.template operator()<true, true>()
                                : run.template operator()<true, false>();
    return options.drop > 0 ? run.template operator()<false, true>()
                            : run.template operator()<false, false>();
}

#define ACTFORMER_NORM(T)                                                                                    \
    template void statistics<T>(const T*, std::int64_t, std::int64_t, T*, T*, int);                          \
    template void norm_forward<T>(const T*, std::int64_t, std::int64_t, const Norm<T>&, const NormOptions&,  \
                                  const T*, T*, int);                                                        \
    template void norm_backward<T>(const T*, std::int64_t, std::int64_t, const Norm<T>&, const NormOptions&, \
                                   const T*, const T*, T*, T*, T*, T*, int);
ACTFORMER_NORM(float)
ACTFORMER_NORM(double)

}  // namespace actformer::model::cpu
