// Attention over one sequence at a time: long ones as matrix products, short ones in plain loops.
#pragma once

#include <cmath>

#include "model/cpu/dropped_rows.hpp"
#include "model/cpu/kernel_support.hpp"
#include "model/cpu/transformer_kernels.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {

/// What scratch memory is for.
namespace sequence_memory {
struct ScoreRows {};
struct KeptScores {};
struct ScoreGrad {};
struct ValueGrad {};
struct OuterPanel {};
struct ShortScores {};
struct ShortGrads {};
struct PackedQkv {};
struct PackedGrad {};
struct PackedValues {};
}  // namespace sequence_memory

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

    /// `kept` holds the bits of the weights that dropout leaves, (heads, length keys, length queries).
    void forward(Sequence<const T> qkv, Sequence<T> seen, const KeptRows<T>& kept = {}) const {
        T* scores = scratch<T>(sequence_memory::ScoreRows{}, length_ * room_);
        T* panel = scratch<T>(sequence_memory::OuterPanel{}, length_ * panel_columns<T>);
        pack_all(packed_scratch<T>(sequence_memory::PackedQkv{}), qkv);
        for (std::int64_t h = 0; h < heads_; ++h) {
            const auto at = h * head_;
            weigh(qkv, h, scores);
            if (kept) keep(kept, h, scores, scores);
            over_keys(scores, {qkv.first + 2 * width_ + at, qkv.step}, panel, {seen.first + at, seen.step});
        }
    }

    /// `grad` is of what was seen; `to` takes the gradients of queries, keys and values.
    void backward(Sequence<const T> qkv, Sequence<const T> grad, Sequence<T> to,
                  const KeptRows<T>& kept = {}) const {
        T* scores = scratch<T>(sequence_memory::ScoreRows{}, length_ * room_);
        T* left = kept ? scratch<T>(sequence_memory::KeptScores{}, length_ * room_) : scores;
        T* slopes = scratch<T>(sequence_memory::ScoreGrad{}, length_ * room_);
        T* panel = scratch<T>(sequence_memory::OuterPanel{}, length_ * panel_columns<T>);
        pack_all(packed_scratch<T>(sequence_memory::PackedQkv{}), qkv);
        pack_all(packed_scratch<T>(sequence_memory::PackedGrad{}), grad);
        for (std::int64_t h = 0; h < heads_; ++h) {
            const auto at = h * head_;
            const Sequence<const T> queries{qkv.first + at, qkv.step}, keys{queries.first + width_, qkv.step},
                values{keys.first + width_, qkv.step};
            weigh(qkv, h, scores);
            if (kept) keep(kept, h, scores, left);
            over_queries(left, {grad.first + at, grad.step}, {to.first + 2 * width_ + at, to.step});
            times_all(packed_scratch<T>(sequence_memory::PackedGrad{}), values, h, slopes);
            if (kept) keep(kept, h, slopes, slopes);
            through_softmax(scores, slopes);
            over_keys(slopes, keys, panel, {to.first + at, to.step});
            over_queries(slopes, queries, {to.first + width_ + at, to.step});
        }
    }

  private:
    /// A head's numbers (length keys, room) where the bits say so, else 0.
    void keep(const KeptRows<T>& kept, std::int64_t h, const T* from, T* to) const {
        for (std::int64_t j = 0; j < length_; ++j)
            for (std::int64_t i = 0; i < room_; i += lanes<T>)
                store(to + j * room_ + i, kept.of(load(from + j * room_ + i), h * length_ + j, i));
    }

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
        times_all(packed_scratch<T>(sequence_memory::PackedQkv{}), {qkv.first + width_ + h * head_, qkv.step},
                  h, scores);
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
        T* sums = zeroed_scratch<T>(sequence_memory::ValueGrad{}, length_ * pitch);
        add_outer_products<T>(
            matrix, room_, length_, [=](std::int64_t r) { return tokens.at(r); }, head_, length_, panel, sums,
            pitch);
        for (std::int64_t i = 0; i < length_; ++i) std::copy_n(sums + i * pitch, head_, to.at(i));
    }

    /// For every key the sum over queries of matrix (keys, queries) times the queries' tokens.
    void over_queries(const T* matrix, Sequence<const T> tokens, Sequence<T> to) const {
        auto& packed = packed_scratch<T>(sequence_memory::PackedValues{});
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
        T* slopes = scratch<T>(sequence_memory::ShortGrads{}, length_ * length_ * room_);
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
        T* scores = scratch<T>(sequence_memory::ShortScores{}, length_ * length_ * room_);
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

}  // namespace actformer::model::cpu
