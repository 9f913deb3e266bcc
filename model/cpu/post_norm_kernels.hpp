// Sublayers of a post-norm transformer block, as ACTOR's are (Petrovich et al., ICCV 2021), on processors,
// forward and backward; else as transformer_kernels.hpp. What each of them gives is norm(x + dropout(branch)).
//
// A sample's rows are one sequence: shapes have one person and do not look over persons.
#pragma once

#include "model/cpu/random_kernel.hpp"
#include "model/cpu/transformer_kernels.hpp"

namespace actformer::model::cpu {

/// The norm behind a sum, and what is dropped of the branch before.
template <typename T>
struct PostNorm {
    NormWeight<T> norm;
    double epsilon;
    Dropout branch;
};

/// The branch is proj(attention(qkv(x))), `weights_dropout` being of the softmax's weights.
template <typename T>
struct AttentionNormWeights {
    LinearWeight<T> qkv, proj;
    PostNorm<T> post;
    Dropout weights_dropout;
};

/// Kept for the backward pass: as AttentionKept, and the sums before the norm, (rows, width). Null where nothing is kept.
template <typename T>
struct AttentionNormKept {
    T *qkv, *seen, *sum;
};

/// `out` may be `x` where nothing is kept.
template <typename T>
void attention_norm_forward(const AttentionShape& shape, const T* x, const AttentionNormWeights<T>& weights,
                            const AttentionNormKept<T>& kept, T* out, int threads);

template <typename T>
void attention_norm_backward(const AttentionShape& shape, const T* x, const AttentionNormWeights<T>& weights,
                             const AttentionNormKept<const T>& kept, const T* grad,
                             const AttentionGradients<T>& to, int threads);

/// The branch is down(dropout(gelu(up(x)))).
template <typename T>
struct MlpNormWeights {
    LinearWeight<T> up, down;
    PostNorm<T> post;
    Dropout hidden_dropout;
};

/// up's outputs (rows, hidden_pitch), and the sums (rows, width).
template <typename T>
struct MlpNormKept {
    T *up, *sum;
};

template <typename T>
void mlp_norm_forward(const MlpShape& shape, const T* x, const MlpNormWeights<T>& weights,
                      const MlpNormKept<T>& kept, T* out, int threads);

template <typename T>
void mlp_norm_backward(const MlpShape& shape, const T* x, const MlpNormWeights<T>& weights,
                       const MlpNormKept<const T>& kept, const T* grad, const MlpGradients<T>& to,
                       int threads);

/// The branch is the same for every row of a sample, the sum of `parts` vectors and a bias; dropout of parts is row by row.
struct SumShape {
    TokenShape tokens;
    std::int64_t parts;
};

template <typename T>
struct SumNormWeights {
    const T *parts, *bias;  ///< (samples, parts, width), (width)
    PostNorm<T> post;
    Dropout parts_dropout;
};

/// `sum` (rows, width), null where nothing is kept.
template <typename T>
void sum_norm_forward(const SumShape& shape, const T* x, const SumNormWeights<T>& weights, T* sum, T* out,
                      int threads);

template <typename T>
struct SumNormGradients {
    T *x, *parts, *bias;
    ParameterGradient<T> norm;
};

template <typename T>
void sum_norm_backward(const SumShape& shape, const SumNormWeights<T>& weights, const T* sum, const T* grad,
                       const SumNormGradients<T>& to, int threads);

}  // namespace actformer::model::cpu
