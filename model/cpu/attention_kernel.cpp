// The first half of a transformer block, a sample at a time: long sequences as matrix products, short ones in plain loops.
#include "model/cpu/kernel_support.hpp"
#include "model/cpu/transformer_kernels.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct NormalRows {};
struct QkvRows {};
struct SeenRows {};
struct ScoreRows {};
struct SeenGrad {};
struct ScoreGrad {};
struct QkvGrad {};
struct NormalGrad {};
struct ValueGrad {};
struct OuterPanel {};
struct QkvBias {};
struct ProjBias {};
struct ShortScores {};
struct ShortGrads {};
struct SumsNormWeight {};
struct SumsNormBias {};
struct SumsQkv {};
struct SumsQkvBias {};
struct SumsProj {};
struct SumsProjBias {};
struct QkvWeight {};
struct ProjWeight {};
struct PackedQkv {};
struct PackedGrad {};
struct PackedValues {};

/// Sequences of at most so many tokens are worth no packing.
constexpr std::int64_t short_length = 8;

/// Where a sequence's queries lie; its keys and values follow `width` and twice `width` numbers behind.
template <typename T>
struct Sequence {
    T* first;
    std::int64_t step;  ///< numbers from one token to the next

    T* at(std::int64_t i) const { return first + i * step; }
};

/// Attention over sequences of one length. Scores lie key by key, (length, queries), so that a softmax runs down the rows
/// for a vector of queries at once.
template <typename T>
class LongAttention {
  public:
    LongAttention(const AttentionShape& shape)
        : length_(shape.length()),
          head_(shape.head()),
          heads_(shape.heads),
          width_(shape.tokens.width),
          room_(padded<T>(length_)),
          scale_(1 / std::sqrt(static_cast<T>(head_))) {}

    void forward(Sequence<const T> qkv, Sequence<T> seen) const {
        T* scores = scratch<T>(ScoreRows{}, length_ * room_);
        T* panel = scratch<T>(OuterPanel{}, length_ * panel_columns<T>);
        pack_all(packed_scratch<T>(PackedQkv{}), qkv);
        for (std::int64_t h = 0; h < heads_; ++h) {
            const auto at = h * head_;
            weigh(qkv, h, scores);
            over_keys(scores, {qkv.first + 2 * width_ + at, qkv.step}, panel, {seen.first + at, seen.step});
        }
    }

    /// `grad` is of what was seen; `to` takes the gradients of queries, keys and values.
    void backward(Sequence<const T> qkv, Sequence<const T> grad, Sequence<T> to) const {
        T* scores = scratch<T>(ScoreRows{}, length_ * room_);
        T* slopes = scratch<T>(ScoreGrad{}, length_ * room_);
        T* panel = scratch<T>(OuterPanel{}, length_ * panel_columns<T>);
        pack_all(packed_scratch<T>(PackedQkv{}), qkv);
        pack_all(packed_scratch<T>(PackedGrad{}), grad);
        for (std::int64_t h = 0; h < heads_; ++h) {
            const auto at = h * head_;
            const Sequence<const T> queries{qkv.first + at, qkv.step}, keys{queries.first + width_, qkv.step},
                values{keys.first + width_, qkv.step};
            weigh(qkv, h, scores);
            over_queries(scores, {grad.first + at, grad.step}, {to.first + 2 * width_ + at, to.step});
            times_all(packed_scratch<T>(PackedGrad{}), values, h, slopes);
            through_softmax(scores, slopes);
            over_keys(slopes, keys, panel, {to.first + at, to.step});
            over_queries(slopes, queries, {to.first + width_ + at, to.step});
        }
    }

  private:
    /// All heads' numbers of the tokens as columns, (width, length): a head's are `head_` rows of every panel.
    void pack_all(PackedMatrix<T>& to, Sequence<const T> tokens) const {
        to.resize(width_, length_);
        for (std::int64_t p = 0; p < to.panels(); ++p)
            to.fill_transposed(p, tokens.first, tokens.step, length_);
    }

    /// to (length, room) = every row times every packed token, within a head.
    void times_all(const PackedMatrix<T>& packed, Sequence<const T> rows, std::int64_t h, T* to) const {
        for (std::int64_t p = 0; p < packed.panels(); ++p) {
            const auto first = p * panel_columns<T>;
            panel_product<T>(EvenRows<T>{rows.first, rows.step}, length_,
                             packed.panel(p) + h * head_ * panel_columns<T>, head_,
                             room_ - first > lanes<T> ? panel_vectors : 1, StorePlain<T>{to + first, room_});
        }
    }

    /// The weights of every key (length, room) for the queries.
    void weigh(Sequence<const T> qkv, std::int64_t h, T* scores) const {
        times_all(packed_scratch<T>(PackedQkv{}), {qkv.first + width_ + h * head_, qkv.step}, h, scores);
        for (std::int64_t i = 0; i < room_; i += lanes<T>) {
            T* column = scores + i;
            Lanes<T> most = load(column), sum = {};
            for (std::int64_t j = 1; j < length_; ++j) {
                const auto here = load(column + j * room_);
                most = here > most ? here : most;
            }
            for (std::int64_t j = 0; j < length_; ++j) {
                const auto power = exponential((load(column + j * room_) - most) * scale_);
                store(column + j * room_, power);
                sum += power;
            }
            const auto over = 1 / sum;
            for (std::int64_t j = 0; j < length_; ++j)
                store(column + j * room_, load(column + j * room_) * over);
        }
    }

    /// From the weights' gradient to that of what their softmax was taken of, before its scale.
    void through_softmax(const T* weights, T* grads) const {
        for (std::int64_t i = 0; i < room_; i += lanes<T>) {
            Lanes<T> mean = {};
            for (std::int64_t j = 0; j < length_; ++j)
                mean += load(weights + j * room_ + i) * load(grads + j * room_ + i);
            for (std::int64_t j = 0; j < length_; ++j) {
                T* to = grads + j * room_ + i;
                store(to, load(weights + j * room_ + i) * (load(to) - mean) * scale_);
            }
        }
    }

    /// For every query the sum over keys of matrix (keys, queries) times the keys' tokens.
    void over_keys(const T* matrix, Sequence<const T> tokens, T* panel, Sequence<T> to) const {
        const auto pitch = panel_padded<T>(head_);
        T* sums = zeroed_scratch<T>(ValueGrad{}, length_ * pitch);
        add_outer_products<T>(
            matrix, room_, length_, [=](std::int64_t r) { return tokens.at(r); }, head_, length_, panel, sums,
            pitch);
        for (std::int64_t i = 0; i < length_; ++i) std::copy_n(sums + i * pitch, head_, to.at(i));
    }

    /// For every key the sum over queries of matrix (keys, queries) times the queries' tokens.
    void over_queries(const T* matrix, Sequence<const T> tokens, Sequence<T> to) const {
        auto& packed = packed_scratch<T>(PackedValues{});
        packed.resize(length_, head_);
        for (std::int64_t p = 0; p < packed.panels(); ++p) packed.fill(p, tokens.first, tokens.step, head_);
        product<T>(EvenRows<T>{matrix, room_}, length_, packed, head_,
                   StoreExact<T>{to.first, to.step, head_});
    }

    std::int64_t length_, head_, heads_, width_, room_;
    T scale_;
};

/// The same for a handful of tokens: scores (length, length, heads), so that the softmax runs over all heads at once.
template <typename T>
class ShortAttention {
  public:
    ShortAttention(const AttentionShape& shape)
        : length_(shape.length()),
          head_(shape.head()),
          heads_(shape.heads),
          width_(shape.tokens.width),
          room_(padded<T>(heads_)),
          scale_(1 / std::sqrt(static_cast<T>(head_))) {}

    void forward(Sequence<const T> qkv, Sequence<T> seen) const {
        const T* scores = weigh(qkv);
        for (std::int64_t i = 0; i < length_; ++i)
            for (std::int64_t h = 0; h < heads_; ++h) {
                T* to = seen.at(i) + h * head_;
                for (std::int64_t c = 0; c < head_; c += lanes<T>) {
                    const auto here = std::min<std::int64_t>(lanes<T>, head_ - c);
                    Lanes<T> sum = {};
                    for (std::int64_t j = 0; j < length_; ++j)
                        sum +=
                            score(scores, i, j)[h] * load_part(qkv.at(j) + 2 * width_ + h * head_ + c, here);
                    store_part(to + c, sum, here);
                }
            }
    }

    void backward(Sequence<const T> qkv, Sequence<const T> grad, Sequence<T> to) const {
        const T* scores = weigh(qkv);
        T* slopes = scratch<T>(ShortGrads{}, length_ * length_ * room_);
        for (std::int64_t i = 0; i < length_; ++i) std::fill_n(to.at(i), 3 * width_, T(0));
        for (std::int64_t i = 0; i < length_; ++i)
            for (std::int64_t j = 0; j < length_; ++j)
                for (std::int64_t h = 0; h < heads_; ++h) {
                    const auto at = h * head_;
                    score(slopes, i, j)[h] = dot(grad.at(i) + at, qkv.at(j) + 2 * width_ + at, head_);
                    add_scaled(grad.at(i) + at, score(scores, i, j)[h], head_, to.at(j) + 2 * width_ + at);
                }
        for (std::int64_t i = 0; i < length_; ++i) through_softmax(scores, slopes, i);
        for (std::int64_t i = 0; i < length_; ++i)
            for (std::int64_t j = 0; j < length_; ++j)
                for (std::int64_t h = 0; h < heads_; ++h) {
                    const auto at = h * head_;
                    const T slope = score(slopes, i, j)[h];
                    add_scaled(qkv.at(j) + width_ + at, slope, head_, to.at(i) + at);
                    add_scaled(qkv.at(i) + at, slope, head_, to.at(j) + width_ + at);
                }
    }

  private:
    template <typename Number>
    Number* score(Number* scores, std::int64_t i, std::int64_t j) const {
        return scores + (i * length_ + j) * room_;
    }

    const T* weigh(Sequence<const T> qkv) const {
        T* scores = scratch<T>(ShortScores{}, length_ * length_ * room_);
        for (std::int64_t i = 0; i < length_; ++i) {
            for (std::int64_t j = 0; j < length_; ++j)
                for (std::int64_t h = 0; h < heads_; ++h)
                    score(scores, i, j)[h] =
                        scale_ * dot(qkv.at(i) + h * head_, qkv.at(j) + width_ + h * head_, head_);
            softmax(scores, i);
        }
        return scores;
    }

    void softmax(T* scores, std::int64_t i) const {
        for (std::int64_t h = 0; h < heads_; h += lanes<T>) {
            Lanes<T> most = load(score(scores, i, 0) + h), sum = {};
            for (std::int64_t j = 1; j < length_; ++j) {
                const auto here = load(score(scores, i, j) + h);
                most = here > most ? here : most;
            }
            for (std::int64_t j = 0; j < length_; ++j) {
                const auto power = exponential(load(score(scores, i, j) + h) - most);
                store(score(scores, i, j) + h, power);
                sum += power;
            }
            for (std::int64_t j = 0; j < length_; ++j)
                store(score(scores, i, j) + h, load(score(scores, i, j) + h) / sum);
        }
    }

    void through_softmax(const T* weights, T* grads, std::int64_t i) const {
        for (std::int64_t h = 0; h < heads_; h += lanes<T>) {
            Lanes<T> mean = {};
            for (std::int64_t j = 0; j < length_; ++j)
                mean += load(score(weights, i, j) + h) * load(score(grads, i, j) + h);
            for (std::int64_t j = 0; j < length_; ++j) {
                T* to = score(grads, i, j) + h;
                store(to, load(score(weights, i, j) + h) * (load(to) - mean) * scale_);
            }
        }
    }

    std::int64_t length_, head_, heads_, width_, room_;
    T scale_;
};

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
    auto &qkv_weight = packed_scratch<T>(QkvWeight{}), &proj_weight = packed_scratch<T>(ProjWeight{});
    pack_forward(qkv_weight, weights.qkv.weight, 3 * width, width, threads);
    pack_forward(proj_weight, weights.proj.weight, width, width, threads);
    const T *bias_qkv = padded_copy(QkvBias{}, weights.qkv.bias, 3 * width),
            *bias_proj = padded_copy(ProjBias{}, weights.proj.bias, width);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
        const T* from = x + n * rows * width;
        T* normal = scratch<T>(NormalRows{}, rows * pitch);
        T* qkv = kept.qkv ? kept.qkv + n * rows * qkv_pitch : scratch<T>(QkvRows{}, rows * qkv_pitch);
        T* seen = kept.seen ? kept.seen + n * rows * seen_pitch : scratch<T>(SeenRows{}, rows * seen_pitch);
        for (std::int64_t r = 0; r < rows; ++r)
            normalise_row(from + r * width, width, weights.norm.weight, weights.norm.bias,
                          normal + r * pitch);
        product<T>(EvenRows<T>{normal, pitch}, rows, qkv_weight, 3 * width,
                   StoreBiased<T>{qkv, qkv_pitch, bias_qkv});
        if (shape.length() <= short_length)
            attend<T, ShortAttention<T>>(shape, qkv, seen);
        else
            attend<T, LongAttention<T>>(shape, qkv, seen);
        product<T>(EvenRows<T>{seen, seen_pitch}, rows, proj_weight, width,
                   StoreAdded<T>{from, out + n * rows * width, width, width, bias_proj});
    }
}

template <typename T>
void attention_backward(const AttentionShape& shape, const T* x, const AttentionWeights<T>& weights,
                        const AttentionKept<const T>& kept, const T* grad, const AttentionGradients<T>& to,
                        int threads) {
    const auto width = shape.tokens.width, rows = shape.tokens.sample_rows();
    const auto pitch = padded<T>(width), qkv_pitch = shape.qkv_pitch(), seen_pitch = shape.seen_pitch();
    auto &qkv_weight = packed_scratch<T>(QkvWeight{}), &proj_weight = packed_scratch<T>(ProjWeight{});
    pack_backward(qkv_weight, weights.qkv.weight, 3 * width, width, threads);
    pack_backward(proj_weight, weights.proj.weight, width, width, threads);
    ThreadSums<T> norm_weight(threads, 1, width), norm_bias(threads, 1, width),
        qkv_sums(threads, 3 * width, width), qkv_bias_sums(threads, 1, 3 * width),
        proj_sums(threads, width, width), proj_bias_sums(threads, 1, width);
#pragma omp parallel num_threads(threads)
    {
        T *own_norm = norm_weight.own(SumsNormWeight{}), *own_norm_bias = norm_bias.own(SumsNormBias{}),
          *own_qkv = qkv_sums.own(SumsQkv{}), *own_qkv_bias = qkv_bias_sums.own(SumsQkvBias{}),
          *own_proj = proj_sums.own(SumsProj{}), *own_proj_bias = proj_bias_sums.own(SumsProjBias{});
        T* normal = scratch<T>(NormalRows{}, rows * pitch);
        T* to_seen = scratch<T>(SeenGrad{}, rows * pitch);
        T* to_qkv = scratch<T>(QkvGrad{}, rows * qkv_pitch);
        T* back = scratch<T>(NormalGrad{}, rows * pitch);
        T* panel = scratch<T>(OuterPanel{}, rows * panel_columns<T>);
#pragma omp for schedule(static)
        for (std::int64_t n = 0; n < shape.tokens.samples; ++n) {
            const auto first = n * rows * width;
            const T *from = x + first, *g = grad + first, *qkv = kept.qkv + n * rows * qkv_pitch,
                    *seen = kept.seen + n * rows * seen_pitch;
            product<T>(EvenRows<T>{g, width}, rows, proj_weight, width, StorePlain<T>{to_seen, pitch});
            add_outer_products<T>(
                g, width, width, [=](std::int64_t r) { return seen + r * seen_pitch; }, width, rows, panel,
                own_proj, proj_sums.pitch());
            if (shape.length() <= short_length)
                attend_backward<T, ShortAttention<T>>(shape, qkv, to_seen, pitch, to_qkv);
            else
                attend_backward<T, LongAttention<T>>(shape, qkv, to_seen, pitch, to_qkv);
            for (std::int64_t r = 0; r < rows; ++r) {
                normalise_row(from + r * width, width, weights.norm.weight, weights.norm.bias,
                              normal + r * pitch);
                add_row(g + r * width, width, own_proj_bias);
                add_row(to_qkv + r * qkv_pitch, 3 * width, own_qkv_bias);
            }
            add_outer_products<T>(
                to_qkv, qkv_pitch, 3 * width, [=](std::int64_t r) { return normal + r * pitch; }, width, rows,
                panel, own_qkv, qkv_sums.pitch());
            product<T>(EvenRows<T>{to_qkv, qkv_pitch}, rows, qkv_weight, width, StorePlain<T>{back, pitch});
            for (std::int64_t r = 0; r < rows; ++r)
                normalise_row_backward(from + r * width, back + r * pitch, width, weights.norm.weight,
                                       g + r * width, to.x + first + r * width, own_norm, own_norm_bias);
        }
        norm_weight.write(to.norm.weight);
        norm_bias.write(to.norm.bias);
        qkv_sums.write(to.qkv.weight);
        qkv_bias_sums.write(to.qkv.bias);
        proj_sums.write(to.proj.weight);
        proj_bias_sums.write(to.proj.bias);
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
