// Graph convolution over the edges, frames at a time.
#include <cstring>
#include <vector>

#include "model/cpu/kernel_support.hpp"
#include "model/cpu/layer_kernels.hpp"
#include "model/cpu/row_products.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct GatheredRows {};
struct SumsWeight {};
struct SumsStrength {};
struct SumsBias {};

/// About as many rows at once as fit in the first-level cache beside a panel.
std::int64_t frames_at_once(const MotionShape& shape) {
    return std::max<std::int64_t>(1, 100 / shape.joints);
}

/// gathered (frames, K, pitch): for every target joint and part the sum of its sources, part after part.
template <typename T>
void gather(std::span<const Edge> edges, const T* strength, const T* x, std::int64_t in, std::int64_t frames,
            std::int64_t joints, std::int64_t pitch, T* gathered) {
    std::memset(gathered, 0, sizeof(T) * static_cast<std::size_t>(frames * joints * pitch));
    for (std::int64_t t = 0; t < frames; ++t)
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const T* from = x + (t * joints + edges[e].source) * in;
            T* to = gathered + (t * joints + edges[e].target) * pitch + edges[e].part * in;
            const T by = strength[e];
            for (std::int64_t c = 0; c < in; ++c) to[c] += by * from[c];
        }
}

/// The backward pass: gathered's gradient to x's and the strengths'.
template <typename T>
void scatter(std::span<const Edge> edges, const T* strength, const T* x, std::int64_t in, std::int64_t frames,
             std::int64_t joints, std::int64_t pitch, const T* gathered, T* grad_x, T* grad_strength) {
    std::memset(grad_x, 0, sizeof(T) * static_cast<std::size_t>(frames * joints * in));
    for (std::int64_t t = 0; t < frames; ++t)
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const auto source = (t * joints + edges[e].source) * in;
            const T* grad = gathered + (t * joints + edges[e].target) * pitch + edges[e].part * in;
            const T by = strength[e];
            const T* from = x + source;
            T* to = grad_x + source;
            T dot = 0;
#pragma omp simd reduction(+ : dot)
            for (std::int64_t c = 0; c < in; ++c) {
                to[c] += by * grad[c];
                dot += from[c] * grad[c];
            }
            grad_strength[e] += dot;
        }
}

/// (rows, columns) to (columns, rows padded with zeros).
template <typename T>
std::vector<T> transposed(const T* values, std::int64_t rows, std::int64_t columns, std::int64_t pitch) {
    std::vector<T> out(static_cast<std::size_t>(columns * pitch), T(0));
    for (std::int64_t r = 0; r < rows; ++r)
        for (std::int64_t c = 0; c < columns; ++c)
            out[static_cast<std::size_t>(c * pitch + r)] = values[r * columns + c];
    return out;
}

}  // namespace

template <typename T>
void graph_forward(const MotionShape& shape, std::span<const Edge> edges, const T* strength, const T* x,
                   std::int64_t in, const T* weight, const T* bias, std::int64_t out, T* y, int threads) {
    const Panels<T> panels(weight, 3 * in, out, out);
    const auto joints = shape.joints, pitch = padded<T>(3 * in), all = shape.samples * shape.frames;
    const auto step = frames_at_once(shape);
#pragma omp parallel num_threads(threads)
    {
        T* gathered = scratch<T>(GatheredRows{}, step * joints * pitch);
#pragma omp for schedule(static)
        for (std::int64_t t = 0; t < all; t += step) {
            const auto frames = std::min(step, all - t);
            gather(edges, strength, x + t * joints * in, in, frames, joints, pitch, gathered);
            T* to = y + t * joints * out;
            for (std::int64_t f = 0; f < frames; ++f) std::copy_n(bias, joints * out, to + f * joints * out);
            add_product<T>({gathered, joints * pitch, pitch}, panels, {to, joints * out, out}, frames,
                           joints);
        }
    }
}

template <typename T>
void graph_backward(const MotionShape& shape, std::span<const Edge> edges, const T* strength, const T* x,
                    std::int64_t in, const T* weight, std::int64_t out, const T* grad,
                    const GraphGradients<T>& to, int threads) {
    const auto joints = shape.joints, pitch = padded<T>(3 * in), all = shape.samples * shape.frames;
    const auto step = frames_at_once(shape);
    const auto back = transposed(weight, 3 * in, out, pitch);
    const Panels<T> panels(back.data(), out, pitch, pitch);
    const auto edge_count = static_cast<std::int64_t>(edges.size());
    ThreadSums<T> weight_sums(threads, 3 * in, out, pitch), strength_sums(threads, 1, edge_count),
        bias_sums(threads, 1, joints * out);
#pragma omp parallel num_threads(threads)
    {
        T *own_weight = weight_sums.own(SumsWeight{}), *own_strength = strength_sums.own(SumsStrength{}),
          *own_bias = bias_sums.own(SumsBias{});
        T* gathered = scratch<T>(GatheredRows{}, step * joints * pitch);
#pragma omp for schedule(static)
        for (std::int64_t t = 0; t < all; t += step) {
            const auto frames = std::min(step, all - t);
            const T *from = x + t * joints * in, *g = grad + t * joints * out;
            const Rows<const T> g_rows{g, joints * out, out};
            gather(edges, strength, from, in, frames, joints, pitch, gathered);
            add_outer<T>({gathered, joints * pitch, pitch}, g_rows, frames, joints, pitch, out, own_weight,
                         weight_sums.pitch());
            for (std::int64_t f = 0; f < frames; ++f) add_row(g + f * joints * out, joints * out, own_bias);
            std::fill_n(gathered, step * joints * pitch, T(0));
            add_product<T>(g_rows, panels, {gathered, joints * pitch, pitch}, frames, joints);
            scatter(edges, strength, from, in, frames, joints, pitch, gathered, to.x + t * joints * in,
                    own_strength);
        }
        weight_sums.write(to.weight);
        strength_sums.write(to.strength);
        bias_sums.write(to.bias);
    }
}

#define ACTFORMER_GRAPH(T)                                                                         \
    template void graph_forward<T>(const MotionShape&, std::span<const Edge>, const T*, const T*,  \
                                   std::int64_t, const T*, const T*, std::int64_t, T*, int);       \
    template void graph_backward<T>(const MotionShape&, std::span<const Edge>, const T*, const T*, \
                                    std::int64_t, const T*, std::int64_t, const T*,                \
                                    const GraphGradients<T>&, int);
ACTFORMER_GRAPH(float)
ACTFORMER_GRAPH(double)

}  // namespace actformer::model::cpu
