// The first sublayer of a transformer block, a sample at a time: long sequences as matrix products, short ones in plain loops.
#include "model/cpu/layer_support.hpp"
#include "model/cpu/sequence_attention.hpp"
#include "model/cpu/transformer_kernels.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct NormalRows {};
struct QkvRows {};
struct SeenRows {};
struct SeenGrad {};
struct QkvGrad {};
struct NormalGrad {};
struct QkvLayer {};
struct ProjLayer {};
struct NormLayer {};

/// Sequences of at most so many tokens are worth no packing.
constexpr std::int64_t short_length = 8;

/// Calls use(first row, rows from one token to the next) for every sequence of a sample.
template <typename Use>
void for_each_sequence(const AttentionShape& shape, const Use& use) {
    const auto tokens = shape.tokens.tokens;
    for (std::int64_t s = 0; s < shape.sequences(); ++s)
        shape.over_persons ? use(s, tokens) : use(s * tokens, std::int64_t{1});
}

template <typename T, typename Attention>
void attend(const AttentionShape& shape, const T* qkv, T* seen) {
    const Attention attention(shape);
    const auto pitch = shape.qkv_pitch(), seen_pitch = shape.seen_pitch();
    for_each_sequence(shape, [&](std::int64_t row, std::int64_t step) {
        attention.forward({qkv + row * pitch, step * pitch}, {seen + row * seen_pitch, step * seen_pitch});
    });
}

template <typename T, typename Attention>
void attend_backward(const AttentionShape& shape, const T* qkv, const T* grad, std::int64_t grad_pitch,
                     T* to) {
    const Attention attention(shape);
    const auto pitch = shape.qkv_pitch();
    for_each_sequence(shape, [&](std::int64_t row, std::int64_t step) {
        attention.backward({qkv + row * pitch, step * pitch}, {grad + row * grad_pitch, step * grad_pitch},
                           {to + row * pitch, step * pitch});
    });
}

}  // namespace

std::int64_t AttentionShape::qkv_pitch() const {
    return (3 * tokens.width + 15) / 16 * 16;
}

std::int64_t AttentionShape::seen_pitch() const {
    const auto spill = (head() + 31) / 32 * 32;
    return (tokens.width - head() + spill + 15) / 16 * 16;
}

template <typename T>
void attention_forward(const AttentionShape& shape, const T* x, const AttentionWeights<T>& weights,
                       const AttentionKept<T>& kept, T* out, int threads) {
    const auto width = shape.tokens.width, rows = shape.tokens.sample_rows();
    const auto pitch = padded<T>(width), qkv_pitch = shape.qkv_pitch(), seen_pitch = shape.seen_pitch();
    const auto qkv_map = packed_forward(QkvLayer{}, weights.qkv, 3 * width, width, threads),
               proj_map = packed_forward(ProjLayer{}, weights.proj, width, width, threads);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
        const T* from = x + n * rows * width;
        T* normal = scratch<T>(NormalRows{}, rows * pitch);
        T* qkv = kept.qkv ? kept.qkv + n * rows * qkv_pitch : scratch<T>(QkvRows{}, rows * qkv_pitch);
        T* seen = kept.seen ? kept.seen + n * rows * seen_pitch : scratch<T>(SeenRows{}, rows * seen_pitch);
        normalise_rows(from, rows, width, weights.norm, normal, pitch);
        product<T>(EvenRows<T>{normal, pitch}, rows, qkv_map.weight, 3 * width,
                   StoreBiased<T>{qkv, qkv_pitch, qkv_map.bias});
        if (shape.length() <= short_length)
            attend<T, ShortAttention<T>>(shape, qkv, seen);
        else
            attend<T, LongAttention<T>>(shape, qkv, seen);
        product<T>(EvenRows<T>{seen, seen_pitch}, rows, proj_map.weight, width,
                   StoreAdded<T>{from, out + n * rows * width, width, width, proj_map.bias});
    }
}

template <typename T>
void attention_backward(const AttentionShape& shape, const T* x, const AttentionWeights<T>& weights,
                        const AttentionKept<const T>& kept, const T* grad, const AttentionGradients<T>& to,
                        int threads) {
    const auto width = shape.tokens.width, rows = shape.tokens.sample_rows();
    const auto pitch = padded<T>(width), qkv_pitch = shape.qkv_pitch(), seen_pitch = shape.seen_pitch();
    const auto &qkv_weight = packed_backward(QkvLayer{}, weights.qkv, 3 * width, width, threads),
               &proj_weight = packed_backward(ProjLayer{}, weights.proj, width, width, threads);
    NormSums<T> norm_sums(threads, width);
    LinearSums<T> qkv_sums(threads, 3 * width, width), proj_sums(threads, width, width);
#pragma omp parallel num_threads(threads)
    {
        const auto own_norm = norm_sums.own(NormLayer{});
        const auto own_qkv = qkv_sums.own(QkvLayer{}), own_proj = proj_sums.own(ProjLayer{});
        T* normal = scratch<T>(NormalRows{}, rows * pitch);
        T* to_seen = scratch<T>(SeenGrad{}, rows * pitch);
        T* to_qkv = scratch<T>(QkvGrad{}, rows * qkv_pitch);
        T* back = scratch<T>(NormalGrad{}, rows * pitch);
#pragma omp for schedule(static)
        for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
            const auto first = n * rows * width;
            const T *from = x + first, *g = grad + first, *qkv = kept.qkv + n * rows * qkv_pitch,
                    *seen = kept.seen + n * rows * seen_pitch;
            product<T>(EvenRows<T>{g, width}, rows, proj_weight, width, StorePlain<T>{to_seen, pitch});
            own_proj.add({g, width}, {seen, seen_pitch}, rows);
            if (shape.length() <= short_length)
                attend_backward<T, ShortAttention<T>>(shape, qkv, to_seen, pitch, to_qkv);
            else
                attend_backward<T, LongAttention<T>>(shape, qkv, to_seen, pitch, to_qkv);
            normalise_rows(from, rows, width, weights.norm, normal, pitch);
            own_qkv.add({to_qkv, qkv_pitch}, {normal, pitch}, rows);
            product<T>(EvenRows<T>{to_qkv, qkv_pitch}, rows, qkv_weight, width, StorePlain<T>{back, pitch});
            normalise_rows_backward(from, back, pitch, rows, width, weights.norm, g, to.x + first, own_norm);
        }
        norm_sums.write(to.norm);
        qkv_sums.write(to.qkv);
        proj_sums.write(to.proj);
    }
}

#define ACTFORMER_ATTENTION(T)                                                                       \
    template void attention_forward<T>(const AttentionShape&, const T*, const AttentionWeights<T>&,  \
                                       const AttentionKept<T>&, T*, int);                            \
    template void attention_backward<T>(const AttentionShape&, const T*, const AttentionWeights<T>&, \
                                        const AttentionKept<const T>&, const T*,                     \
                                        const AttentionGradients<T>&, int);
ACTFORMER_ATTENTION(float)
ACTFORMER_ATTENTION(double)

}  // namespace actformer::model::cpu
