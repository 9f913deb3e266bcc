// Vectors as wide as the processor's, float or double: loads and stores of whole ones and of parts, transposes, sums.
#pragma once

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <cstddef>
#include <type_traits>

namespace actformer::model::cpu {

#if defined(__AVX512F__)
constexpr std::size_t vector_bytes = 64;
#else
constexpr std::size_t vector_bytes = 32;
#endif

template <typename T>
struct Vector {
    typedef T type __attribute__((vector_size(vector_bytes), aligned(alignof(T)), may_alias));
};

/// Numbers of T in a vector: channel counts are padded to a multiple of it.
template <typename T>
constexpr std::ptrdiff_t lanes = vector_bytes / sizeof(T);

template <typename T>
constexpr std::ptrdiff_t padded(std::ptrdiff_t n) {
    return (n + lanes<T> - 1) / lanes<T> * lanes<T>;
}

template <typename T>
using Lanes = typename Vector<T>::type;

template <typename T>
inline Lanes<T> load(const T* from) {
    return *reinterpret_cast<const Lanes<T>*>(from);
}

template <typename T>
inline void store(T* to, Lanes<T> value) {
    *reinterpret_cast<Lanes<T>*>(to) = value;
}

#if defined(__AVX512F__)
/// A mask of the first `count` numbers of a vector.
template <typename T>
inline auto first_lanes(std::ptrdiff_t count) {
    using Mask = std::conditional_t<std::is_same_v<T, float>, __mmask16, __mmask8>;
    return static_cast<Mask>((1U << count) - 1U);
}
#endif

/// The first `count` numbers of a vector, at most all.
template <typename T>
inline void store_part(T* to, Lanes<T> value, std::ptrdiff_t count) {
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<T, float>)
        _mm512_mask_storeu_ps(to, first_lanes<T>(count), __m512(value));
    else
        _mm512_mask_storeu_pd(to, first_lanes<T>(count), __m512d(value));
#else
    for (std::ptrdiff_t i = 0; i < count; ++i) to[i] = value[i];
#endif
}

/// The first `count` numbers in memory, zeros behind them.
template <typename T>
inline Lanes<T> load_part(const T* from, std::ptrdiff_t count) {
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<T, float>)
        return Lanes<T>(_mm512_maskz_loadu_ps(first_lanes<T>(count), from));
    else
        return Lanes<T>(_mm512_maskz_loadu_pd(first_lanes<T>(count), from));
#else
    Lanes<T> value = {};
    for (std::ptrdiff_t i = 0; i < count; ++i) value[i] = from[i];
    return value;
#endif
}

#if defined(__AVX512F__)
/// 16 rows of 16 numbers, of which `rows` x `columns` are there and the others zeros, as columns: pairs of rows are woven
/// into each other by single numbers, then by twos, then quarters of vectors change places twice.
inline void transpose_16(const float* from, std::ptrdiff_t pitch, std::ptrdiff_t rows, std::ptrdiff_t columns,
                         float* to, std::ptrdiff_t to_pitch) {
    Lanes<float> in[16], mid[16];
#pragma GCC unroll 16
    for (int r = 0; r < 16; ++r) in[r] = r < rows ? load_part(from + r * pitch, columns) : Lanes<float>{};
#pragma GCC unroll 8
    for (int r = 0; r < 16; r += 2) {
        mid[r] = __builtin_shufflevector(in[r], in[r + 1], 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28,
                                         13, 29);
        mid[r + 1] = __builtin_shufflevector(in[r], in[r + 1], 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14,
                                             30, 15, 31);
    }
#pragma GCC unroll 4
    for (int r = 0; r < 16; r += 4)
#pragma GCC unroll 2
        for (int half = 0; half < 2; ++half) {
            const auto a = mid[r + half], b = mid[r + half + 2];
            in[r + 2 * half] =
                __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
            in[r + 2 * half + 1] =
                __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
        }
    const auto even = [](Lanes<float> a, Lanes<float> b) {
        return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27);
    };
    const auto odd = [](Lanes<float> a, Lanes<float> b) {
        return __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
    };
#pragma GCC unroll 4
    for (int c = 0; c < 4; ++c) {
        const auto low = even(in[c], in[4 + c]), high = odd(in[c], in[4 + c]),
                   next_low = even(in[8 + c], in[12 + c]), next_high = odd(in[8 + c], in[12 + c]);
        mid[c] = even(low, next_low);
        mid[c + 4] = even(high, next_high);
        mid[c + 8] = odd(low, next_low);
        mid[c + 12] = odd(high, next_high);
    }
#pragma GCC unroll 16
    for (int c = 0; c < 16; ++c)
        if (c < columns) store(to + c * to_pitch, mid[c]);
}
#endif

/// to (columns, rows padded with zeros to whole vectors) from (rows, columns).
template <typename T>
inline void transpose(const T* from, std::ptrdiff_t pitch, std::ptrdiff_t rows, std::ptrdiff_t columns, T* to,
                      std::ptrdiff_t to_pitch) {
    constexpr std::ptrdiff_t block = lanes<T>;
    for (std::ptrdiff_t r = 0; r < rows; r += block)
        for (std::ptrdiff_t c = 0; c < columns; c += block) {
            const auto here = std::min(block, rows - r), wide = std::min(block, columns - c);
            const T* corner = from + r * pitch + c;
            T* turned = to + c * to_pitch + r;
#if defined(__AVX512F__)
            if constexpr (std::is_same_v<T, float>) {
                transpose_16(corner, pitch, here, wide, turned, to_pitch);
                continue;
            }
#endif
            for (std::ptrdiff_t j = 0; j < wide; ++j)
                for (std::ptrdiff_t i = 0; i < block; ++i)
                    turned[j * to_pitch + i] = i < here ? corner[i * pitch + j] : T(0);
        }
}

/// The sum of a vector's numbers, by halves.
inline float sum_of(Lanes<float> x) {
#if defined(__AVX512F__)
    x += __builtin_shufflevector(x, x, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7);
    x += __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11);
    x += __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
    return x[0] + x[1];
#else
    x += __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3);
    x += __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5);
    return x[0] + x[1];
#endif
}

inline double sum_of(Lanes<double> x) {
    double sum = 0;
    for (std::ptrdiff_t i = 0; i < lanes<double>; ++i) sum += x[i];
    return sum;
}

/// The sum of the products of `count` numbers.
template <typename T>
inline T dot(const T* a, const T* b, std::ptrdiff_t count) {
    Lanes<T> sum = {};
    std::ptrdiff_t i = 0;
    for (; i + lanes<T> <= count; i += lanes<T>) sum += load(a + i) * load(b + i);
    if (i < count) sum += load_part(a + i, count - i) * load_part(b + i, count - i);
    return sum_of(sum);
}

/// to += by * from, `count` numbers.
template <typename T>
inline void add_scaled(const T* from, T by, std::ptrdiff_t count, T* to) {
    std::ptrdiff_t i = 0;
    for (; i + lanes<T> <= count; i += lanes<T>) store(to + i, load(to + i) + by * load(from + i));
    if (i < count)
        store_part(to + i, load_part(to + i, count - i) + by * load_part(from + i, count - i), count - i);
}

}  // namespace actformer::model::cpu
