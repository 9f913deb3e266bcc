// The second sublayer of a transformer block, a sample at a time.
#include "model/cpu/layer_support.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct NormalRows {};
struct ActiveRows {};
struct HiddenGrad {};
struct NormalGrad {};
struct UpLayer {};
struct DownLayer {};
struct NormLayer {};

template <typename T>
void activate(const T* up, std::int64_t count, T* to) {
    for (std::int64_t i = 0; i < count; i += lanes<T>) store(to + i, gelu(load(up + i)).value);
}

/// `grad` becomes the gradient to `up`, `active` up's activation. `count` is whole vectors.
template <typename T>
void activate_backward(const T* up, std::int64_t count, T* active, T* grad) {
    for (std::int64_t i = 0; i < count; i += lanes<T>) {
        const auto g = gelu(load(up + i));
        store(active + i, g.value);
        store(grad + i, load(grad + i) * g.slope);
    }
}

}  // namespace

std::int64_t MlpShape::hidden_pitch() const {
    return (hidden + 15) / 16 * 16;
}

template <typename T>
void mlp_forward(const MlpShape& shape, const T* x, const MlpWeights<T>& weights, T* kept, T* out,
                 int threads) {
    const auto width = shape.tokens.width, hidden = shape.hidden, rows = shape.tokens.sample_rows();
    const auto pitch = padded<T>(width), hidden_pitch = shape.hidden_pitch();
    const auto up = packed_forward(UpLayer{}, weights.up, hidden, width, threads),
               down = packed_forward(DownLayer{}, weights.down, width, hidden, threads);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
        const T* from = x + n * rows * width;
        T* normal = scratch<T>(NormalRows{}, rows * pitch);
        T* active = scratch<T>(ActiveRows{}, rows * hidden_pitch);
        T* mapped = kept ? kept + n * rows * hidden_pitch : active;
        normalise_rows(from, rows, width, weights.norm, normal, pitch);
        product<T>(EvenRows<T>{normal, pitch}, rows, up.weight, hidden,
                   StoreBiased<T>{mapped, hidden_pitch, up.bias});
        activate(mapped, rows * hidden_pitch, active);
        product<T>(EvenRows<T>{active, hidden_pitch}, rows, down.weight, width,
                   StoreAdded<T>{from, out + n * rows * width, width, width, down.bias});
    }
}

template <typename T>
void mlp_backward(const MlpShape& shape, const T* x, const MlpWeights<T>& weights, const T* kept,
                  const T* grad, const MlpGradients<T>& to, int threads) {
    const auto width = shape.tokens.width, hidden = shape.hidden, rows = shape.tokens.sample_rows();
    const auto pitch = padded<T>(width), hidden_pitch = shape.hidden_pitch();
    const auto &up = packed_backward(UpLayer{}, weights.up, hidden, width, threads),
               &down = packed_backward(DownLayer{}, weights.down, width, hidden, threads);
    NormSums<T> norm_sums(threads, width);
    LinearSums<T> up_sums(threads, hidden, width), down_sums(threads, width, hidden);
#pragma omp parallel num_threads(threads)
    {
        const auto own_norm = norm_sums.own(NormLayer{});
        const auto own_up = up_sums.own(UpLayer{}), own_down = down_sums.own(DownLayer{});
        T* normal = scratch<T>(NormalRows{}, rows * pitch);
        T* active = scratch<T>(ActiveRows{}, rows * hidden_pitch);
        T* inner = scratch<T>(HiddenGrad{}, rows * hidden_pitch);
        T* back = scratch<T>(NormalGrad{}, rows * pitch);
#pragma omp for schedule(static)
        for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
            const auto first = n * rows * width;
            const T *from = x + first, *g = grad + first;
            product<T>(EvenRows<T>{g, width}, rows, down, hidden, StorePlain<T>{inner, hidden_pitch});
            activate_backward(kept + n * rows * hidden_pitch, rows * hidden_pitch, active, inner);
            own_down.add({g, width}, {active, hidden_pitch}, rows);
            normalise_rows(from, rows, width, weights.norm, normal, pitch);
            own_up.add({inner, hidden_pitch}, {normal, pitch}, rows);
            product<T>(EvenRows<T>{inner, hidden_pitch}, rows, up, width, StorePlain<T>{back, pitch});
            normalise_rows_backward(from, back, pitch, rows, width, weights.norm, g, to.x + first, own_norm);
        }
        norm_sums.write(to.norm);
        up_sums.write(to.up);
        down_sums.write(to.down);
    }
}

#define ACTFORMER_MLP(T)                                                                               \
    template void mlp_forward<T>(const MlpShape&, const T*, const MlpWeights<T>&, T*, T*, int);        \
    template void mlp_backward<T>(const MlpShape&, const T*, const MlpWeights<T>&, const T*, const T*, \
                                  const MlpGradients<T>&, int);
ACTFORMER_MLP(float)
ACTFORMER_MLP(double)

}  // namespace actformer::model::cpu
