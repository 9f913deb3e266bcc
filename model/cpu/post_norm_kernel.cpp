// Sublayers of a post-norm transformer block, a sample at a time.
#include "model/cpu/post_norm_kernels.hpp"

#include "model/cpu/dropped_rows.hpp"
#include "model/cpu/layer_support.hpp"
#include "model/cpu/sequence_attention.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct BranchRows {};
struct BranchGrad {};
struct BranchBits {};
struct InnerBits {};
struct QkvRows {};
struct SeenRows {};
struct SeenGrad {};
struct QkvGrad {};
struct MappedRows {};
struct ActiveRows {};
struct HiddenGrad {};
struct NoBias {};
struct FirstLayer {};
struct SecondLayer {};
struct NormLayer {};
struct SharedBias {};

template <typename T, typename Purpose>
KeptRows<T> drawn(Purpose purpose, const Dropout& dropout, std::int64_t sample, std::int64_t rows,
                  std::int64_t columns) {
    return kept_rows<T>(dropout, sample, rows, columns,
                        [&](std::int64_t words) { return scratch<std::uint16_t>(purpose, words); });
}

/// norm(x + dropout(branch)) of a sample's rows. Rows of x, sums and gradients have exactly `width` numbers, rows of branches
/// `pitch`.
template <typename T>
class ResidualNorm {
  public:
    ResidualNorm(const PostNorm<T>& post, const TokenShape& tokens)
        : post_(post), rows_(tokens.sample_rows()), width_(tokens.width), pitch_(panel_padded<T>(width_)) {}

    std::int64_t pitch() const { return pitch_; }
    T* branch_rows() const { return scratch<T>(BranchRows{}, rows_ * pitch_); }

    /// `sum` may be null; `out` may be `x`.
    void forward(std::int64_t sample, const T* x, T* branch, T* sum, T* out) const {
        const auto kept = drawn<T>(BranchBits{}, post_.branch, sample, rows_, width_);
        for (std::int64_t r = 0; r < rows_; ++r) {
            T* to = sum ? sum + r * width_ : branch + r * pitch_;
            add(x + r * width_, branch + r * pitch_, kept, r, to);
            normalise_row(to, width_, post_.norm, out + r * width_, post_.epsilon);
        }
    }

    /// From the gradient of what forward gave to that of x, as far as it comes by the sum, and of the branch, (rows, pitch).
    void backward(std::int64_t sample, const T* sum, const T* grad, T* to_x, T* to_branch,
                  const ParameterGradient<T>& own) const {
        const auto kept = drawn<T>(BranchBits{}, post_.branch, sample, rows_, width_);
        for (std::int64_t r = 0; r < rows_; ++r) {
            T* to = to_x + r * width_;
            normalise_row_backward<T>(sum + r * width_, grad + r * width_, width_, post_.norm.weight, nullptr,
                                      to, own, post_.epsilon);
            for (std::int64_t c = 0; c < width_; c += lanes<T>) {
                const auto here = load_part(to + c, std::min<std::int64_t>(lanes<T>, width_ - c));
                store(to_branch + r * pitch_ + c, kept ? kept.of(here, r, c) : here);
            }
        }
    }

  private:
    void add(const T* x, const T* branch, const KeptRows<T>& kept, std::int64_t row, T* to) const {
        for (std::int64_t c = 0; c < width_; c += lanes<T>) {
            const auto here = std::min<std::int64_t>(lanes<T>, width_ - c);
            const auto more = load(branch + c);
            store_part(to + c, load_part(x + c, here) + (kept ? kept.of(more, row, c) : more), here);
        }
    }

    const PostNorm<T>& post_;
    std::int64_t rows_, width_, pitch_;
};

/// to_x += rows times a packed weight, which gives `width` numbers.
template <typename T>
void add_product_to(const T* rows, std::int64_t pitch, std::int64_t count, const PackedMatrix<T>& weight,
                    std::int64_t width, T* to_x) {
    const T* none = zeroed_scratch<T>(NoBias{}, panel_padded<T>(width));
    product<T>(EvenRows<T>{rows, pitch}, count, weight, width, StoreAdded<T>{to_x, to_x, width, width, none});
}

/// gelu of up's outputs, without what is dropped.
template <typename T>
void activate(const T* up, std::int64_t rows, std::int64_t pitch, const KeptRows<T>& kept, T* to) {
    for (std::int64_t r = 0; r < rows; ++r, up += pitch, to += pitch)
        for (std::int64_t c = 0; c < pitch; c += lanes<T>) {
            const auto active = gelu(load(up + c)).value;
            store(to + c, kept ? kept.of(active, r, c) : active);
        }
}

/// `grad` becomes the gradient to `up`, `active` what activate() gives.
template <typename T>
void activate_backward(const T* up, std::int64_t rows, std::int64_t pitch, const KeptRows<T>& kept, T* active,
                       T* grad) {
    for (std::int64_t r = 0; r < rows; ++r, up += pitch, active += pitch, grad += pitch)
        for (std::int64_t c = 0; c < pitch; c += lanes<T>) {
            const auto g = gelu(load(up + c));
            const auto slope = load(grad + c) * g.slope;
            store(active + c, kept ? kept.of(g.value, r, c) : g.value);
            store(grad + c, kept ? kept.of(slope, r, c) : slope);
        }
}

}  // namespace

template <typename T>
void attention_norm_forward(const AttentionShape& shape, const T* x, const AttentionNormWeights<T>& weights,
                            const AttentionNormKept<T>& kept, T* out, int threads) {
    const auto width = shape.tokens.width, rows = shape.length();
    const auto qkv_pitch = shape.qkv_pitch(), seen_pitch = shape.seen_pitch();
    const auto qkv_map = packed_forward(FirstLayer{}, weights.qkv, 3 * width, width, threads),
               proj_map = packed_forward(SecondLayer{}, weights.proj, width, width, threads);
    const LongAttention<T> attention(shape);
    const ResidualNorm<T> residual(weights.post, shape.tokens);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
        const auto first = n * rows;
        T* qkv = kept.qkv ? kept.qkv + first * qkv_pitch : scratch<T>(QkvRows{}, rows * qkv_pitch);
        T* seen = kept.seen ? kept.seen + first * seen_pitch : scratch<T>(SeenRows{}, rows * seen_pitch);
        T* branch = residual.branch_rows();
        product<T>(EvenRows<T>{x + first * width, width}, rows, qkv_map.weight, 3 * width,
                   StoreBiased<T>{qkv, qkv_pitch, qkv_map.bias});
        attention.forward({qkv, qkv_pitch}, {seen, seen_pitch},
                          drawn<T>(InnerBits{}, weights.weights_dropout, n, shape.heads * rows, rows));
        product<T>(EvenRows<T>{seen, seen_pitch}, rows, proj_map.weight, width,
                   StoreBiased<T>{branch, residual.pitch(), proj_map.bias});
        residual.forward(n, x + first * width, branch, kept.sum ? kept.sum + first * width : nullptr,
                         out + first * width);
    }
}

template <typename T>
void attention_norm_backward(const AttentionShape& shape, const T* x, const AttentionNormWeights<T>& weights,
                             const AttentionNormKept<const T>& kept, const T* grad,
                             const AttentionGradients<T>& to, int threads) {
    const auto width = shape.tokens.width, rows = shape.length();
    const auto qkv_pitch = shape.qkv_pitch(), seen_pitch = shape.seen_pitch();
    const auto &qkv_weight = packed_backward(FirstLayer{}, weights.qkv, 3 * width, width, threads),
               &proj_weight = packed_backward(SecondLayer{}, weights.proj, width, width, threads);
    const LongAttention<T> attention(shape);
    const ResidualNorm<T> residual(weights.post, shape.tokens);
    const auto pitch = residual.pitch();
    NormSums<T> norm_sums(threads, width);
    LinearSums<T> qkv_sums(threads, 3 * width, width), proj_sums(threads, width, width);
#pragma omp parallel num_threads(threads)
    {
        const auto own_norm = norm_sums.own(NormLayer{});
        const auto own_qkv = qkv_sums.own(FirstLayer{}), own_proj = proj_sums.own(SecondLayer{});
        T* to_branch = scratch<T>(BranchGrad{}, rows * pitch);
        T* to_seen = scratch<T>(SeenGrad{}, rows * pitch);
        T* to_qkv = scratch<T>(QkvGrad{}, rows * qkv_pitch);
#pragma omp for schedule(static)
        for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
            const auto first = n * rows;
            const T *from = x + first * width, *qkv = kept.qkv + first * qkv_pitch,
                    *seen = kept.seen + first * seen_pitch;
            T* to_x = to.x + first * width;
            residual.backward(n, kept.sum + first * width, grad + first * width, to_x, to_branch, own_norm);
            product<T>(EvenRows<T>{to_branch, pitch}, rows, proj_weight, width,
                       StorePlain<T>{to_seen, pitch});
            own_proj.add({to_branch, pitch}, {seen, seen_pitch}, rows);
            attention.backward({qkv, qkv_pitch}, {to_seen, pitch}, {to_qkv, qkv_pitch},
                               drawn<T>(InnerBits{}, weights.weights_dropout, n, shape.heads * rows, rows));
            own_qkv.add({to_qkv, qkv_pitch}, {from, width}, rows);
            add_product_to(to_qkv, qkv_pitch, rows, qkv_weight, width, to_x);
        }
        norm_sums.write(to.norm);
        qkv_sums.write(to.qkv);
        proj_sums.write(to.proj);
    }
}

template <typename T>
void mlp_norm_forward(const MlpShape& shape, const T* x, const MlpNormWeights<T>& weights,
                      const MlpNormKept<T>& kept, T* out, int threads) {
    const auto width = shape.tokens.width, hidden = shape.hidden, rows = shape.tokens.sample_rows();
    const auto hidden_pitch = shape.hidden_pitch();
    const auto up = packed_forward(FirstLayer{}, weights.up, hidden, width, threads),
               down = packed_forward(SecondLayer{}, weights.down, width, hidden, threads);
    const ResidualNorm<T> residual(weights.post, shape.tokens);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
        const auto first = n * rows;
        T* active = scratch<T>(ActiveRows{}, rows * hidden_pitch);
        T* mapped = kept.up ? kept.up + first * hidden_pitch : active;
        T* branch = residual.branch_rows();
        product<T>(EvenRows<T>{x + first * width, width}, rows, up.weight, hidden,
                   StoreBiased<T>{mapped, hidden_pitch, up.bias});
        activate(mapped, rows, hidden_pitch, drawn<T>(InnerBits{}, weights.hidden_dropout, n, rows, hidden),
                 active);
        product<T>(EvenRows<T>{active, hidden_pitch}, rows, down.weight, width,
                   StoreBiased<T>{branch, residual.pitch(), down.bias});
        residual.forward(n, x + first * width, branch, kept.sum ? kept.sum + first * width : nullptr,
                         out + first * width);
    }
}

template <typename T>
void mlp_norm_backward(const MlpShape& shape, const T* x, const MlpNormWeights<T>& weights,
                       const MlpNormKept<const T>& kept, const T* grad, const MlpGradients<T>& to,
                       int threads) {
    const auto width = shape.tokens.width, hidden = shape.hidden, rows = shape.tokens.sample_rows();
    const auto hidden_pitch = shape.hidden_pitch();
    const auto &up = packed_backward(FirstLayer{}, weights.up, hidden, width, threads),
               &down = packed_backward(SecondLayer{}, weights.down, width, hidden, threads);
    const ResidualNorm<T> residual(weights.post, shape.tokens);
    const auto pitch = residual.pitch();
    NormSums<T> norm_sums(threads, width);
    LinearSums<T> up_sums(threads, hidden, width), down_sums(threads, width, hidden);
#pragma omp parallel num_threads(threads)
    {
        const auto own_norm = norm_sums.own(NormLayer{});
        const auto own_up = up_sums.own(FirstLayer{}), own_down = down_sums.own(SecondLayer{});
        T* to_branch = scratch<T>(BranchGrad{}, rows * pitch);
        T* active = scratch<T>(ActiveRows{}, rows * hidden_pitch);
        T* inner = scratch<T>(HiddenGrad{}, rows * hidden_pitch);
#pragma omp for schedule(static)
        for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
            const auto first = n * rows;
            T* to_x = to.x + first * width;
            residual.backward(n, kept.sum + first * width, grad + first * width, to_x, to_branch, own_norm);
            product<T>(EvenRows<T>{to_branch, pitch}, rows, down, hidden, StorePlain<T>{inner, hidden_pitch});
            activate_backward(kept.up + first * hidden_pitch, rows, hidden_pitch,
                              drawn<T>(InnerBits{}, weights.hidden_dropout, n, rows, hidden), active, inner);
            own_down.add({to_branch, pitch}, {active, hidden_pitch}, rows);
            own_up.add({inner, hidden_pitch}, {x + first * width, width}, rows);
            add_product_to(inner, hidden_pitch, rows, up, width, to_x);
        }
        norm_sums.write(to.norm);
        up_sums.write(to.up);
        down_sums.write(to.down);
    }
}

template <typename T>
void sum_norm_forward(const SumShape& shape, const T* x, const SumNormWeights<T>& weights, T* sum, T* out,
                      int threads) {
    const auto width = shape.tokens.width, rows = shape.tokens.sample_rows();
    const ResidualNorm<T> residual(weights.post, shape.tokens);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
        const auto first = n * rows;
        const T* parts = weights.parts + n * shape.parts * width;
        const auto kept = drawn<T>(InnerBits{}, weights.parts_dropout, n, rows, shape.parts);
        T* branch = residual.branch_rows();
        for (std::int64_t r = 0; r < rows; ++r) {
            T* to = branch + r * residual.pitch();
            std::copy_n(weights.bias, width, to);
            for (std::int64_t p = 0; p < shape.parts; ++p)
                add_scaled(parts + p * width, kept.share(r, p), width, to);
        }
        residual.forward(n, x + first * width, branch, sum ? sum + first * width : nullptr,
                         out + first * width);
    }
}

template <typename T>
void sum_norm_backward(const SumShape& shape, const SumNormWeights<T>& weights, const T* sum, const T* grad,
                       const SumNormGradients<T>& to, int threads) {
    const auto width = shape.tokens.width, rows = shape.tokens.sample_rows();
    const ResidualNorm<T> residual(weights.post, shape.tokens);
    const auto pitch = residual.pitch();
    NormSums<T> norm_sums(threads, width);
    ThreadSums<T> bias(threads, 1, width);
#pragma omp parallel num_threads(threads)
    {
        const auto own_norm = norm_sums.own(NormLayer{});
        T* own_bias = bias.own(SharedBias{});
        T* to_branch = scratch<T>(BranchGrad{}, rows * pitch);
#pragma omp for schedule(static)
        for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
            const auto first = n * rows;
            T* to_parts = to.parts + n * shape.parts * width;
            const auto kept = drawn<T>(InnerBits{}, weights.parts_dropout, n, rows, shape.parts);
            residual.backward(n, sum + first * width, grad + first * width, to.x + first * width, to_branch,
                              own_norm);
            for (std::int64_t r = 0; r < rows; ++r) add_row(to_branch + r * pitch, width, own_bias);
            std::fill_n(to_parts, shape.parts * width, T(0));
            for (std::int64_t r = 0; r < rows; ++r)
                for (std::int64_t p = 0; p < shape.parts; ++p)
                    add_scaled(to_branch + r * pitch, kept.share(r, p), width, to_parts + p * width);
        }
        norm_sums.write(to.norm);
        bias.write(to.bias);
    }
}

#define ACTFORMER_POST_NORM(T)                                                                               \
    template void attention_norm_forward<T>(const AttentionShape&, const T*, const AttentionNormWeights<T>&, \
                                            const AttentionNormKept<T>&, T*, int);                           \
    template void attention_norm_backward<T>(                                                                \
        const AttentionShape&, const T*, const AttentionNormWeights<T>&, const AttentionNormKept<const T>&,  \
        const T*, const AttentionGradients<T>&, int);                                                        \
    template void mlp_norm_forward<T>(const MlpShape&, const T*, const MlpNormWeights<T>&,                   \
                                      const MlpNormKept<T>&, T*, int);                                       \
    template void mlp_norm_backward<T>(const MlpShape&, const T*, const MlpNormWeights<T>&,                  \
                                       const MlpNormKept<const T>&, const T*, const MlpGradients<T>&, int);  \
    template void sum_norm_forward<T>(const SumShape&, const T*, const SumNormWeights<T>&, T*, T*, int);     \
    template void sum_norm_backward<T>(const SumShape&, const SumNormWeights<T>&, const T*, const T*,        \
                                       const SumNormGradients<T>&, int);
ACTFORMER_POST_NORM(float)
ACTFORMER_POST_NORM(double)

}  // namespace actformer::model::cpu
