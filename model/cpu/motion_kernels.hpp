// The generator's two ends on processors: latents to tokens, tokens to motions. T float or double.
#pragma once

#include "ingest/dataset/representation.hpp"
#include "model/cpu/transformer_kernels.hpp"

namespace actformer::model::cpu {

/// Latents (samples, streams, frames, channels); streams are 1 or `persons`.
struct EmbeddingShape {
    std::int64_t samples, streams, persons, frames, channels, width;
    std::int64_t tokens() const { return frames + 1; }
};

/// Tokens (samples, persons, frames + 1, width): the class's row first, then every frame's latent W^T + bias, each plus its
/// position. `classes` (samples, width), `positions` (frames + 1, persons, width).
template <typename T>
void embed_forward(const EmbeddingShape& shape, const T* latent, const LinearWeight<T>& weight,
                   const T* classes, const T* positions, T* tokens, int threads);

template <typename T>
struct EmbeddingGradients {
    ParameterGradient<T> weight;
    T *classes, *positions;
};

template <typename T>
void embed_backward(const EmbeddingShape& shape, const T* latent, const T* grad,
                    const EmbeddingGradients<T>& to, int threads);

/// Motions (samples, persons * numbers, frames, nodes) from tokens: norm, linear map to the numbers of every node, and what
/// the representation makes of them (ingest::Finish).
struct PoseShape {
    TokenShape tokens;
    std::int64_t nodes;
    ingest::Representation representation;
    std::int64_t numbers() const { return representation.numbers(); }
    std::int64_t frames() const { return tokens.tokens - 1; }
    std::int64_t raw_pitch() const;  ///< numbers a row has in what is kept
};

template <typename T>
struct PoseWeights {
    NormWeight<T> norm;
    LinearWeight<T> head;  ///< (nodes * numbers, width)
};

/// `kept` (samples * persons * frames, raw_pitch) takes the linear map's outputs; null where nothing is kept.
template <typename T>
void pose_forward(const PoseShape& shape, const T* x, const PoseWeights<T>& weights, T* kept, T* motion,
                  int threads);

template <typename T>
struct PoseGradients {
    T* x;
    ParameterGradient<T> norm, head;
};

template <typename T>
void pose_backward(const PoseShape& shape, const T* x, const PoseWeights<T>& weights, const T* kept,
                   const T* grad, const PoseGradients<T>& to, int threads);

}  // namespace actformer::model::cpu
