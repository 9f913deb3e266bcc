// Temporal convolution: every tap is a product of shifted frames, taken only where the frame is there.
#include "model/cpu/kernel_support.hpp"
#include "model/cpu/layer_kernels.hpp"
#include "model/cpu/row_products.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct SumsWeight {};
struct SumsBias {};

/// Output frames first .. first+count-1, at t, see input frame t * stride + shift through a tap.
struct Reach {
    std::int64_t first, count, shift;
};

Reach reach_of(const TemporalShape& shape, std::int64_t tap) {
    const auto shift = tap - shape.taps / 2;
    const auto first = shift >= 0 ? 0 : (-shift + shape.stride - 1) / shape.stride;
    const auto beyond = shape.input.frames - shift;  // the input frame t * stride must stay below it
    const auto end =
        std::min(shape.out_frames(), beyond <= 0 ? 0 : (beyond + shape.stride - 1) / shape.stride);
    return {first, std::max<std::int64_t>(0, end - first), shift};
}

/// Input rows as the output frames see them through a tap.
template <typename T>
Rows<T> seen(const TemporalShape& shape, T* sample, const Reach& reach) {
    const auto frame = shape.input.joints * shape.in;
    return {sample + (reach.first * shape.stride + reach.shift) * frame, shape.stride * frame, shape.in};
}

template <typename T>
Rows<T> out_rows(const TemporalShape& shape, T* sample, std::int64_t first) {
    const auto frame = shape.input.joints * shape.out;
    return {sample + first * frame, frame, shape.out};
}

template <typename T>
std::vector<Panels<T>> pack(const TemporalShape& shape, const T* weight) {
    std::vector<Panels<T>> panels;
    for (std::int64_t tap = 0; tap < shape.taps; ++tap)
        panels.emplace_back(weight + tap * shape.in * shape.out, shape.in, shape.out, shape.out);
    return panels;
}

template <typename T>
std::vector<Panels<T>> pack_transposed(const TemporalShape& shape, const T* weight) {
    std::vector<Panels<T>> panels;
    std::vector<T> turned(static_cast<std::size_t>(shape.in * shape.out));
    for (std::int64_t tap = 0; tap < shape.taps; ++tap) {
        for (std::int64_t i = 0; i < shape.in; ++i)
            for (std::int64_t o = 0; o < shape.out; ++o)
                turned[static_cast<std::size_t>(o * shape.in + i)] =
                    weight[(tap * shape.in + i) * shape.out + o];
        panels.emplace_back(turned.data(), shape.out, shape.in, shape.in);
    }
    return panels;
}

/// One sample's share of the weights' gradient, a few frames at a time so that their rows stay in the cache over all taps. Rows of
/// sums (taps*in, out) lie `stride` apart.
template <typename T>
void add_weight_gradient(const TemporalShape& shape, const T* x, const T* grad, T* sums,
                         std::int64_t stride) {
    const auto joints = shape.input.joints, step = std::max<std::int64_t>(1, 100 / joints);
    for (std::int64_t from = 0; from < shape.out_frames(); from += step)
        for (std::int64_t tap = 0; tap < shape.taps; ++tap) {
            auto reach = reach_of(shape, tap);
            const auto first = std::max(from, reach.first),
                       end = std::min(from + step, reach.first + reach.count);
            if (end <= first) continue;
            reach.first = first;
            add_outer<T>(seen(shape, x, reach), out_rows(shape, grad, first), end - first, joints, shape.in,
                         shape.out, sums + tap * shape.in * stride, stride);
        }
}

}  // namespace

template <typename T>
void temporal_forward(const TemporalShape& shape, const T* x, const T* weight, const T* bias, T* y,
                      int threads) {
    const auto panels = pack(shape, weight);
    const auto joints = shape.input.joints, rows = shape.out_frames() * joints;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.input.samples; ++n) {
        T* to = y + n * rows * shape.out;
        const T* from = x + n * shape.input.frames * joints * shape.in;
        for (std::int64_t r = 0; r < rows; ++r) std::copy_n(bias, shape.out, to + r * shape.out);
        for (std::int64_t tap = 0; tap < shape.taps; ++tap) {
            const auto reach = reach_of(shape, tap);
            add_product<T>(seen(shape, from, reach), panels[static_cast<std::size_t>(tap)],
                           out_rows(shape, to, reach.first), reach.count, joints);
        }
    }
}

template <typename T>
void temporal_backward(const TemporalShape& shape, const T* x, const T* weight, const T* grad, T* grad_x,
                       T* grad_weight, T* grad_bias, int threads) {
    const auto panels = pack_transposed(shape, weight);
    const auto joints = shape.input.joints, in_values = shape.input.frames * joints * shape.in;
    const auto rows = shape.out_frames() * joints;
    ThreadSums<T> weight_sums(threads, shape.taps * shape.in, shape.out), bias_sums(threads, 1, shape.out);
#pragma omp parallel num_threads(threads)
    {
        T *own_weight = weight_sums.own(SumsWeight{}), *own_bias = bias_sums.own(SumsBias{});
#pragma omp for schedule(static)
        for (std::int64_t n = 0; n < shape.input.samples; ++n) {
            const T *from = x + n * in_values, *g = grad + n * rows * shape.out;
            T* to = grad_x + n * in_values;
            std::fill_n(to, in_values, T(0));
            for (std::int64_t tap = 0; tap < shape.taps; ++tap) {
                const auto reach = reach_of(shape, tap);
                add_product<T>(out_rows(shape, g, reach.first), panels[static_cast<std::size_t>(tap)],
                               seen(shape, to, reach), reach.count, joints);
            }
            add_weight_gradient(shape, from, g, own_weight, weight_sums.pitch());
            for (std::int64_t r = 0; r < rows; ++r) add_row(g + r * shape.out, shape.out, own_bias);
        }
        weight_sums.write(grad_weight);
        bias_sums.write(grad_bias);
    }
}

#define ACTFORMER_TEMPORAL(T)                                                                       \
    template void temporal_forward<T>(const TemporalShape&, const T*, const T*, const T*, T*, int); \
    template void temporal_backward<T>(const TemporalShape&, const T*, const T*, const T*, T*, T*, T*, int);
ACTFORMER_TEMPORAL(float)
ACTFORMER_TEMPORAL(double)

}  // namespace actformer::model::cpu
