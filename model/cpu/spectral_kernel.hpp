// Spectral normalisation on processors. T float or double; matrices are row-major (rows, columns).
#pragma once

#include <cstdint>

namespace actformer::model::cpu {

/// One power iteration: v = unit(W^T u), u = unit(W v). Returns the singular value that goes with the new vectors.
template <typename T>
T power_iteration(const T* matrix, std::int64_t rows, std::int64_t columns, T* u, T* v, int threads);

/// u^T W v.
template <typename T>
T singular_value(const T* matrix, std::int64_t rows, std::int64_t columns, const T* u, const T* v,
                 int threads);

/// to = from * by
template <typename T>
void scale(const T* from, std::int64_t count, T by, T* to, int threads);

/// The gradient through W / (u^T W v), u and v held: (grad - <grad, normalised> u v^T) / value.
template <typename T>
void spectral_backward(const T* grad, const T* normalised, std::int64_t rows, std::int64_t columns,
                       const T* u, const T* v, T value, T* to, int threads);

}  // namespace actformer::model::cpu
