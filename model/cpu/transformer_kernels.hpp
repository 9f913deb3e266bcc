// Sublayers of the generator's transformer blocks on processors, forward and backward: plain arrays in, plain arrays out, T float or double.
//
// Tokens are (samples, persons, tokens, width). One sublayer is one call, so that a sample's rows stay in the cache
// from the normalisation to the residual, and only what the backward pass needs is written out. Results depend on the number
// of threads (in the order of a weight gradient's sums), not on their timing.
#pragma once

#include <cstdint>

namespace actformer::model::cpu {

struct TokenShape {
    std::int64_t samples, persons, tokens, width;
    std::int64_t sample_rows() const { return persons * tokens; }
    std::int64_t rows() const { return samples * sample_rows(); }
};

template <typename T>
struct NormWeight {
    const T *weight, *bias;  ///< (width)
};

/// y = x W^T + bias.
template <typename T>
struct LinearWeight {
    const T *weight, *bias;  ///< (out, in), (out)
};

template <typename T>
struct ParameterGradient {
    T *weight, *bias;  ///< shaped as the weight, overwritten
};

/// x + proj(attention(qkv(norm(x)))), over the persons of a token or over the tokens of a person.
struct AttentionShape {
    TokenShape tokens;
    std::int64_t heads;
    bool over_persons;

    std::int64_t head() const { return tokens.width / heads; }
    std::int64_t sequences() const { return over_persons ? tokens.tokens : tokens.persons; }
    std::int64_t length() const { return over_persons ? tokens.persons : tokens.tokens; }
    /// Numbers a row has in what is kept for the backward pass.
    std::int64_t qkv_pitch() const;
    std::int64_t seen_pitch() const;
};

template <typename T>
struct AttentionWeights {
    NormWeight<T> norm;
    LinearWeight<T> qkv, proj;
};

/// Kept for the backward pass: queries, keys and values, and what each token saw. Null where nothing is kept.
template <typename T>
struct AttentionKept {
    T *qkv, *seen;  ///< (rows, qkv_pitch), (rows, seen_pitch)
};

/// `out` may be `x` where nothing is kept.
template <typename T>
void attention_forward(const AttentionShape& shape, const T* x, const AttentionWeights<T>& weights,
                       const AttentionKept<T>& kept, T* out, int threads);

template <typename T>
struct AttentionGradients {
    T* x;
    ParameterGradient<T> norm, qkv, proj;
};

template <typename T>
void attention_backward(const AttentionShape& shape, const T* x, const AttentionWeights<T>& weights,
                        const AttentionKept<const T>& kept, const T* grad, const AttentionGradients<T>& to,
                        int threads);

/// x + down(gelu(up(norm(x)))).
struct MlpShape {
    TokenShape tokens;
    std::int64_t hidden;
    std::int64_t hidden_pitch() const;  ///< numbers a row has in what is kept
};

template <typename T>
struct MlpWeights {
    NormWeight<T> norm;
    LinearWeight<T> up, down;
};

/// `kept` (rows, hidden_pitch) takes up's outputs; null where nothing is kept, and `out` may be `x` then.
template <typename T>
void mlp_forward(const MlpShape& shape, const T* x, const MlpWeights<T>& weights, T* kept, T* out,
                 int threads);

template <typename T>
struct MlpGradients {
    T* x;
    ParameterGradient<T> norm, up, down;
};

template <typename T>
void mlp_backward(const MlpShape& shape, const T* x, const MlpWeights<T>& weights, const T* kept,
                  const T* grad, const MlpGradients<T>& to, int threads);

}  // namespace actformer::model::cpu
