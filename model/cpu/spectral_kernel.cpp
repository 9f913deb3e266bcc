#include "model/cpu/spectral_kernel.hpp"

#include <algorithm>
#include <cmath>

#include "model/cpu/kernel_support.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct ColumnSums {};
struct RowProducts {};

/// Below it one thread is done before the others are awake.
constexpr std::int64_t worth_threads = 1 << 18;

constexpr double least_norm = 1e-12;  // as in torch.nn.utils.spectral_norm

int team(std::int64_t count, int threads) {
    return count < worth_threads ? 1 : threads;
}

/// Divides by the length, which it returns.
template <typename T>
T make_unit(T* vector, std::int64_t count) {
    double square = 0;
    for (std::int64_t i = 0; i < count; ++i)
        square += static_cast<double>(vector[i]) * static_cast<double>(vector[i]);
    const T length = static_cast<T>(std::max(std::sqrt(square), least_norm));
    for (std::int64_t i = 0; i < count; ++i) vector[i] /= length;
    return length;
}

/// to = W^T u, every thread's share of the rows summed thread after thread.
template <typename T>
void transposed_product(const T* matrix, std::int64_t rows, std::int64_t columns, const T* u, T* to,
                        int threads) {
    std::vector<T*> own(static_cast<std::size_t>(threads));
#pragma omp parallel num_threads(threads)
    {
        T* sums = own[static_cast<std::size_t>(omp_get_thread_num())] =
            zeroed_scratch<T>(ColumnSums{}, columns);
#pragma omp for schedule(static)
        for (std::int64_t r = 0; r < rows; ++r) add_scaled(matrix + r * columns, u[r], columns, sums);
    }
    std::fill_n(to, columns, T(0));
    for (const T* sums : own)
        if (sums) add_row(sums, columns, to);
}

template <typename T>
void row_dots(const T* matrix, std::int64_t rows, std::int64_t columns, const T* v, T* to, int threads) {
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t r = 0; r < rows; ++r) to[r] = dot(matrix + r * columns, v, columns);
}

}  // namespace

template <typename T>
T power_iteration(const T* matrix, std::int64_t rows, std::int64_t columns, T* u, T* v, int threads) {
    threads = team(rows * columns, threads);
    transposed_product(matrix, rows, columns, u, v, threads);
    make_unit(v, columns);
    row_dots(matrix, rows, columns, v, u, threads);
    return make_unit(u, rows);  // u^T W v, with u along W v
}

template <typename T>
T singular_value(const T* matrix, std::int64_t rows, std::int64_t columns, const T* u, const T* v,
                 int threads) {
    T* products = scratch<T>(RowProducts{}, rows);
    row_dots(matrix, rows, columns, v, products, team(rows * columns, threads));
    return dot(products, u, rows);
}

template <typename T>
void scale(const T* from, std::int64_t count, T by, T* to, int threads) {
#pragma omp parallel for simd num_threads(team(count, threads)) schedule(static)
    for (std::int64_t i = 0; i < count; ++i) to[i] = from[i] * by;
}

template <typename T>
void spectral_backward(const T* grad, const T* normalised, std::int64_t rows, std::int64_t columns,
                       const T* u, const T* v, T value, T* to, int threads) {
    threads = team(rows * columns, threads);
    T* dots = scratch<T>(RowProducts{}, rows);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t r = 0; r < rows; ++r)
        dots[r] = dot(grad + r * columns, normalised + r * columns, columns);
    double along = 0;
    for (std::int64_t r = 0; r < rows; ++r) along += static_cast<double>(dots[r]);
    const T over = 1 / value, pull = static_cast<T>(along) / value;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t r = 0; r < rows; ++r) {
        const T *from = grad + r * columns, by = pull * u[r];
        T* row = to + r * columns;
#pragma omp simd
        for (std::int64_t c = 0; c < columns; ++c) row[c] = from[c] * over - by * v[c];
    }
}

#define ACTFORMER_SPECTRAL(T)                                                                              \
    template T power_iteration<T>(const T*, std::int64_t, std::int64_t, T*, T*, int);                      \
    template T singular_value<T>(const T*, std::int64_t, std::int64_t, const T*, const T*, int);           \
    template void scale<T>(const T*, std::int64_t, T, T*, int);                                            \
    template void spectral_backward<T>(const T*, const T*, std::int64_t, std::int64_t, const T*, const T*, \
                                       T, T*, int);
ACTFORMER_SPECTRAL(float)
ACTFORMER_SPECTRAL(double)

}  // namespace actformer::model::cpu
