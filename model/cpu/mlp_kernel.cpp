// The second sublayer of a transformer block, a sample at a time.
#include "model/cpu/kernel_support.hpp"
#include "model/cpu/transformer_kernels.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct NormalRows {};
struct ActiveRows {};
struct HiddenGrad {};
struct NormalGrad {};
struct OuterPanel {};
struct UpBias {};
struct DownBias {};
struct SumsNormWeight {};
struct SumsNormBias {};
struct SumsUp {};
struct SumsUpBias {};
struct SumsDown {};
struct SumsDownBias {};
struct UpWeight {};
struct DownWeight {};

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
    auto &up = packed_scratch<T>(UpWeight{}), &down = packed_scratch<T>(DownWeight{});
    pack_forward(up, weights.up.weight, hidden, width, threads);
    pack_forward(down, weights.down.weight, width, hidden, threads);
    const T *bias_up = padded_copy(UpBias{}, weights.up.bias, hidden),
            *bias_down = padded_copy(DownBias{}, weights.down.bias, width);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
        const T* from = x + n * rows * width;
        T* normal = scratch<T>(NormalRows{}, rows * pitch);
        T* active = scratch<T>(ActiveRows{}, rows * hidden_pitch);
        T* mapped = kept ? kept + n * rows * hidden_pitch : active;
        for (std::int64_t r = 0; r < rows; ++r)
            normalise_row(from + r * width, width, weights.norm.weight, weights.norm.bias,
                          normal + r * pitch);
        product<T>(EvenRows<T>{normal, pitch}, rows, up, hidden,
                   StoreBiased<T>{mapped, hidden_pitch, bias_up});
        activate(mapped, rows * hidden_pitch, active);
        product<T>(EvenRows<T>{active, hidden_pitch}, rows, down, width,
                   StoreAdded<T>{from, out + n * rows * width, width, width, bias_down});
    }
}

template <typename T>
void mlp_backward(const MlpShape& shape, const T* x, const MlpWeights<T>& weights, const T* kept,
                  const T* grad, const MlpGradients<T>& to, int threads) {
    const auto width = shape.tokens.width, hidden = shape.hidden, rows = shape.tokens.sample_rows();
    const auto pitch = padded<T>(width), hidden_pitch = shape.hidden_pitch();
    auto &up = packed_scratch<T>(UpWeight{}), &down = packed_scratch<T>(DownWeight{});
    pack_backward(up, weights.up.weight, hidden, width, threads);
    pack_backward(down, weights.down.weight, width, hidden, threads);
    ThreadSums<T> norm_weight(threads, 1, width), norm_bias(threads, 1, width),
        up_weight(threads, hidden, width), up_sums(threads, 1, hidden), down_weight(threads, width, hidden),
        down_sums(threads, 1, width);
#pragma omp parallel num_threads(threads)
    {
        T *own_norm = norm_weight.own(SumsNormWeight{}), *own_norm_bias = norm_bias.own(SumsNormBias{}),
          *own_up = up_weight.own(SumsUp{}), *own_up_bias = up_sums.own(SumsUpBias{}),
          *own_down = down_weight.own(SumsDown{}), *own_down_bias = down_sums.own(SumsDownBias{});
        T* normal = scratch<T>(NormalRows{}, rows * pitch);
        T* active = scratch<T>(ActiveRows{}, rows * hidden_pitch);
        T* inner = scratch<T>(HiddenGrad{}, rows * hidden_pitch);
        T* back = scratch<T>(NormalGrad{}, rows * pitch);
        T* panel = scratch<T>(OuterPanel{}, rows * panel_columns<T>);
#pragma omp for schedule(static)
        for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
            const auto first = n * rows * width;
            const T *from = x + first, *g = grad + first;
            product<T>(EvenRows<T>{g, width}, rows, down, hidden, StorePlain<T>{inner, hidden_pitch});
            activate_backward(kept + n * rows * hidden_pitch, rows * hidden_pitch, active, inner);
            for (std::int64_t r = 0; r < rows; ++r) {
                normalise_row(from + r * width, width, weights.norm.weight, weights.norm.bias,
                              normal + r * pitch);
                add_row(g + r * width, width, own_down_bias);
                add_row(inner + r * hidden_pitch, hidden, own_up_bias);
            }
            add_outer_products<T>(
                g, width, width, [=](std::int64_t r) { return active + r * hidden_pitch; }, hidden, rows,
                panel, own_down, down_weight.pitch());
            add_outer_products<T>(
                inner, hidden_pitch, hidden, [=](std::int64_t r) { return normal + r * pitch; }, width, rows,
                panel, own_up, up_weight.pitch());
            product<T>(EvenRows<T>{inner, hidden_pitch}, rows, up, width, StorePlain<T>{back, pitch});
            for (std::int64_t r = 0; r < rows; ++r)
                normalise_row_backward(from + r * width, back + r * pitch, width, weights.norm.weight,
                                       g + r * width, to.x + first + r * width, own_norm, own_norm_bias);
        }
        norm_weight.write(to.norm.weight);
        norm_bias.write(to.norm.bias);
        up_weight.write(to.up.weight);
        up_sums.write(to.up.bias);
        down_weight.write(to.down.weight);
        down_sums.write(to.down.bias);
    }
}

#define ACTFORMER_MLP(T)                                                                               \
    template void mlp_forward<T>(const MlpShape&, const T*, const MlpWeights<T>&, T*, T*, int);        \
    template void mlp_backward<T>(const MlpShape&, const T*, const MlpWeights<T>&, const T*, const T*, \
                                  const MlpGradients<T>&, int);
ACTFORMER_MLP(float)
ACTFORMER_MLP(double)

}  // namespace actformer::model::cpu
