#include <algorithm>
#include <vector>

#include "model/cpu/conditional_norm.hpp"
#include "model/cpu/leaky.hpp"

namespace actformer::model::cpu {
namespace {

/// A sample's own line: what (x - mean) * inverse * gain + shift comes to as x * slope + start.
template <typename T>
struct Line {
    std::vector<T> slope, start;

    Line(const ConditionalNormShape& shape, const ConditionalNorm<T>& norm, std::int64_t sample)
        : slope(static_cast<std::size_t>(shape.channels)), start(slope.size()) {
        const T *gain = norm.gain + sample * shape.channels, *shift = norm.shift + sample * shape.channels;
        T *a = slope.data(), *b = start.data();
#pragma omp simd
        for (std::int64_t c = 0; c < shape.channels; ++c) {
            a[c] = gain[c] * norm.inverse[c];
            b[c] = shift[c] - norm.mean[c] * a[c];
        }
    }
};

/// Calls `run` with where every frame of a sample begins in x and in y.
template <typename Run>
void each_frame(const ConditionalNormShape& shape, std::int64_t sample, const Run& run) {
    for (std::int64_t v = 0; v < shape.nodes; ++v) {
        const auto node = sample * shape.nodes + v;
        for (std::int64_t t = 0; t < shape.frames; ++t)
            run(node * shape.node_in() + (shape.padding + t) * shape.channels,
                node * shape.node_out() + (shape.out_padding + t) * shape.channels);
    }
}

template <typename T>
void clear_padding(std::int64_t node, std::int64_t nodes, std::int64_t padding, T* to) {
    for (std::int64_t v = 0; v < nodes; ++v, to += node) {
        std::fill_n(to, padding, T(0));
        std::fill_n(to + node - padding, padding, T(0));
    }
}

/// Sums of all samples (samples, 2, channels), weighed by their gains, over the numbers of a channel: (2, channels).
template <typename T>
std::vector<T> weighed_means(const ConditionalNormShape& shape, const ConditionalNorm<T>& norm,
                             const ConditionalNormGradients<T>& to) {
    const auto channels = shape.channels;
    std::vector<double> sums(static_cast<std::size_t>(2 * channels), 0);
    for (std::int64_t n = 0; n < shape.samples; ++n)
        for (std::int64_t c = 0; c < channels; ++c) {
            const auto at = n * channels + c;
            sums[static_cast<std::size_t>(c)] += static_cast<double>(norm.gain[at] * to.shift[at]);
            sums[static_cast<std::size_t>(channels + c)] += static_cast<double>(norm.gain[at] * to.gain[at]);
        }
    std::vector<T> means;
    for (const auto sum : sums)
        means.push_back(static_cast<T>(sum / static_cast<double>(shape.numbers_a_channel())));
    return means;
}

}  // namespace

/// Sums in double: their difference then has all of T's digits.
template <typename T>
void conditional_statistics(const ConditionalNormShape& shape, const T* x, T* mean, T* variance,
                            int threads) {
    const auto channels = shape.channels;
    std::vector<double> sums(static_cast<std::size_t>(shape.samples * 2 * channels), 0);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.samples; ++n) {
        double *sum = sums.data() + n * 2 * channels, *squares = sum + channels;
        each_frame(shape, n, [&](std::int64_t at, std::int64_t) {
            const T* from = x + at;
#pragma omp simd
            for (std::int64_t c = 0; c < channels; ++c) {
                const auto number = static_cast<double>(from[c]);
                sum[c] += number;
                squares[c] += number * number;
            }
        });
    }
    const auto count = static_cast<double>(shape.numbers_a_channel());
    for (std::int64_t c = 0; c < channels; ++c) {
        double sum = 0, squares = 0;
        for (std::int64_t n = 0; n < shape.samples; ++n) {
            sum += sums[static_cast<std::size_t>(n * 2 * channels + c)];
            squares += sums[static_cast<std::size_t>((n * 2 + 1) * channels + c)];
        }
        const double middle = sum / count;
        mean[c] = static_cast<T>(middle);
        variance[c] = static_cast<T>(std::max(squares / count - middle * middle, 0.0));  // NaN stays
    }
}

template <typename T>
void conditional_norm_forward(const ConditionalNormShape& shape, const T* x, const ConditionalNorm<T>& norm,
                              T* y, int threads) {
    const auto channels = shape.channels;
    const T leak = norm.leak;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.samples; ++n) {
        const Line<T> line(shape, norm, n);
        const T *slope = line.slope.data(), *start = line.start.data();
        clear_padding(shape.node_out(), shape.nodes, shape.out_padding * channels,
                      y + n * shape.nodes * shape.node_out());
        each_frame(shape, n, [&](std::int64_t at, std::int64_t out) {
            const T* from = x + at;
            T* to = y + out;
#pragma omp simd
            for (std::int64_t c = 0; c < channels; ++c) {
                const T number = from[c] * slope[c] + start[c];
                to[c] = leaky(number, number, leak);
            }
        });
    }
}

template <typename T>
void conditional_norm_backward(const ConditionalNormShape& shape, const T* x, const ConditionalNorm<T>& norm,
                               const T* grad, const ConditionalNormGradients<T>& to, int threads) {
    const auto channels = shape.channels;
    const T leak = norm.leak;
    const T *mean = norm.mean, *inverse = norm.inverse;
    std::fill_n(to.gain, shape.samples * channels, T(0));
    std::fill_n(to.shift, shape.samples * channels, T(0));
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.samples; ++n) {
        const Line<T> line(shape, norm, n);
        const T *slope = line.slope.data(), *start = line.start.data();
        T *gain = to.gain + n * channels, *shift = to.shift + n * channels;
        each_frame(shape, n, [&](std::int64_t at, std::int64_t out) {
            const T *from = x + at, *g = grad + out;
#pragma omp simd
            for (std::int64_t c = 0; c < channels; ++c) {
                const T here = leaky(from[c] * slope[c] + start[c], g[c], leak);
                shift[c] += here;
                gain[c] += here * ((from[c] - mean[c]) * inverse[c]);
            }
        });
    }
    const auto means = weighed_means(shape, norm, to);
    const T *level = means.data(), *along = level + channels;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.samples; ++n) {
        const Line<T> line(shape, norm, n);
        const T *slope = line.slope.data(), *start = line.start.data();
        clear_padding(shape.node_in(), shape.nodes, shape.padding * channels,
                      to.x + n * shape.nodes * shape.node_in());
        each_frame(shape, n, [&](std::int64_t at, std::int64_t out) {
            const T *from = x + at, *g = grad + out;
            T* back = to.x + at;
#pragma omp simd
            for (std::int64_t c = 0; c < channels; ++c) {
                const T here = leaky(from[c] * slope[c] + start[c], g[c], leak);
                const T normal = (from[c] - mean[c]) * inverse[c];
                back[c] = here * slope[c] - inverse[c] * (level[c] + normal * along[c]);
            }
        });
    }
}

#define ACTFORMER_CONDITIONAL_NORM(T)                                                            \
    template void conditional_statistics<T>(const ConditionalNormShape&, const T*, T*, T*, int); \
    template void conditional_norm_forward<T>(const ConditionalNormShape&, const T*,             \
                                              const ConditionalNorm<T>&, T*, int);               \
    template void conditional_norm_backward<T>(const ConditionalNormShape&, const T*,            \
                                               const ConditionalNorm<T>&, const T*,              \
                                               const ConditionalNormGradients<T>&, int);
ACTFORMER_CONDITIONAL_NORM(float)
ACTFORMER_CONDITIONAL_NORM(double)

}  // namespace actformer::model::cpu
