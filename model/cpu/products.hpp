// Matrix products for the networks' inner loops: rows that lie anywhere times packed weights, and sums of outer products.
//
// Accumulators live in registers, in tiles of up to 12 rows by two vectors: as many as keep both multiplier ports busy while
// a row's number is broadcast and a panel's two vectors are read. What becomes of a tile's sums is the caller's: they are
// handed over vector by vector, so that a bias, a residual or a sum over nodes costs no pass of its own.
#pragma once

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "model/cpu/row_products.hpp"

namespace actformer::model::cpu {

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
inline __mmask16 first_lanes(std::ptrdiff_t count) {
    return static_cast<__mmask16>((1U << count) - 1U);
}
#endif

/// The first `count` numbers of a vector, at most all.
template <typename T>
inline void store_part(T* to, Lanes<T> value, std::ptrdiff_t count) {
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<T, float>)
        return _mm512_mask_storeu_ps(to, first_lanes(count), __m512(value));
#endif
    for (std::ptrdiff_t i = 0; i < count; ++i) to[i] = value[i];
}

/// The first `count` numbers in memory, zeros behind them.
template <typename T>
inline Lanes<T> load_part(const T* from, std::ptrdiff_t count) {
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<T, float>) return Lanes<T>(_mm512_maskz_loadu_ps(first_lanes(count), from));
#endif
    Lanes<T> value = {};
    for (std::ptrdiff_t i = 0; i < count; ++i) value[i] = from[i];
    return value;
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

/// Vectors of a panel.
constexpr int panel_vectors = 2;

template <typename T>
constexpr std::ptrdiff_t panel_columns = panel_vectors* lanes<T>;

constexpr int most_rows = vector_bytes == 64 ? 12 : 6;

/// A matrix (depth, columns) in panels of two vectors of columns, the last padded with zeros. Memory is kept from one packing
/// to the next.
template <typename T>
class PackedMatrix {
  public:
    void resize(std::ptrdiff_t depth, std::ptrdiff_t columns) {
        depth_ = depth;
        panels_ = (columns + panel_columns<T> - 1) / panel_columns<T>;
        const auto room = static_cast<std::size_t>(depth * panels_ * panel_columns<T>);
        if (values_.size() < room) values_.resize(room);
    }
    std::ptrdiff_t depth() const { return depth_; }
    std::ptrdiff_t panels() const { return panels_; }
    const T* panel(std::ptrdiff_t p) const { return values_.data() + p * depth_ * panel_columns<T>; }
    T* panel(std::ptrdiff_t p) { return values_.data() + p * depth_ * panel_columns<T>; }

    /// Panel `p` of a matrix that lies there row by row, `pitch` numbers apart.
    void fill(std::ptrdiff_t p, const T* rows, std::ptrdiff_t pitch, std::ptrdiff_t columns) {
        T* to = panel(p);
        const auto first = p * panel_columns<T>, here = std::min(panel_columns<T>, columns - first);
        for (std::ptrdiff_t d = 0; d < depth_; ++d, to += panel_columns<T>) {
            std::copy_n(rows + d * pitch + first, here, to);
            std::fill(to + here, to + panel_columns<T>, T(0));
        }
    }

    /// Panel `p` of a matrix that lies there column by column.
    void fill_transposed(std::ptrdiff_t p, const T* columns_first, std::ptrdiff_t pitch,
                         std::ptrdiff_t columns) {
        const auto first = p * panel_columns<T>;
        for (std::ptrdiff_t v = 0; v < panel_columns<T>; v += lanes<T>) {
            const auto here = std::clamp<std::ptrdiff_t>(columns - first - v, 0, lanes<T>);
            if (here > 0)
                transpose(columns_first + (first + v) * pitch, pitch, here, depth_, panel(p) + v,
                          panel_columns<T>);
            else
                for (std::ptrdiff_t d = 0; d < depth_; ++d)
                    store(panel(p) + d * panel_columns<T> + v, Lanes<T>{});
        }
    }

  private:
    std::ptrdiff_t depth_ = 0, panels_ = 0;
    std::vector<T> values_;
};

/// Rows at a fixed distance.
template <typename T>
struct EvenRows {
    const T* first;
    std::ptrdiff_t pitch;

    template <int R>
    struct Tile {
        const T* first;
        std::ptrdiff_t pitch;
        T at(int r, std::ptrdiff_t d) const { return first[r * pitch + d]; }
    };
    template <int R>
    Tile<R> tile(std::ptrdiff_t row) const {
        return {first + row * pitch, pitch};
    }
};

/// Rows anywhere.
template <typename T>
struct ListedRows {
    const T* const* rows;
    std::ptrdiff_t shift = 0;  ///< numbers, onwards from where each row is said to begin

    template <int R>
    struct Tile {
        const T* row[R];
        T at(int r, std::ptrdiff_t d) const { return row[r][d]; }
    };
    template <int R>
    Tile<R> tile(std::ptrdiff_t first) const {
        Tile<R> out;
        for (int r = 0; r < R; ++r) out.row[r] = rows[first + r] + shift;
        return out;
    }
};

namespace detail {

/// Hands finish(row, column, sums) the sums of R rows times W vectors of a panel.
template <typename T, int R, int W, typename Tile, typename Finish>
inline void product_tile(const Tile& left, const T* right, std::ptrdiff_t depth, std::ptrdiff_t row,
                         std::ptrdiff_t column, const Finish& finish) {
    alignas(vector_bytes) Lanes<T> sum[R][W];  // deduced types of vectors lose the loose alignment
#pragma GCC unroll 16
    for (int r = 0; r < R; ++r)
#pragma GCC unroll 4
        for (int w = 0; w < W; ++w) sum[r][w] = Lanes<T>{};
    for (std::ptrdiff_t d = 0; d < depth; ++d, right += panel_columns<T>) {
        Lanes<T> columns[W];
#pragma GCC unroll 4
        for (int w = 0; w < W; ++w) columns[w] = load(right + w * lanes<T>);
#pragma GCC unroll 16
        for (int r = 0; r < R; ++r) {
            const T factor = left.at(r, d);
#pragma GCC unroll 4
            for (int w = 0; w < W; ++w) sum[r][w] += factor * columns[w];
        }
    }
    finish(row, column, sum);
}

template <typename T, int W, typename Rows, typename Finish, int... Counts>
inline void product_rows(const Rows& rows, std::ptrdiff_t row, int count, const T* panel,
                         std::ptrdiff_t depth, std::ptrdiff_t column, const Finish& finish,
                         std::integer_sequence<int, Counts...> /*counts*/) {
    ((count == Counts + 1 ? product_tile<T, Counts + 1, W>(rows.template tile<Counts + 1>(row), panel, depth,
                                                           row, column, finish)
                          : void()),
     ...);
}

/// Calls use(row, count) for `rows` rows in tiles as even as can be.
template <typename Use>
inline void for_even_tiles(std::ptrdiff_t rows, const Use& use) {
    const auto tiles = (rows + most_rows - 1) / most_rows;
    for (std::ptrdiff_t i = 0; i < tiles; ++i) {
        const auto first = rows * i / tiles;
        use(first, static_cast<int>(rows * (i + 1) / tiles - first));
    }
}

}  // namespace detail

/// Rows times one panel of `vectors` vectors: finish(row, column, sums[R][W]) takes the sums of the R rows from `row` on,
/// columns counted from the panel's.
template <typename T, typename Rows, typename Finish>
inline void panel_product(const Rows& rows, std::ptrdiff_t count, const T* panel, std::ptrdiff_t depth,
                          int vectors, const Finish& finish) {
    using Counts = std::make_integer_sequence<int, most_rows>;
    detail::for_even_tiles(count, [&](std::ptrdiff_t row, int here) {
        if (vectors == panel_vectors)
            detail::product_rows<T, panel_vectors>(rows, row, here, panel, depth, 0, finish, Counts{});
        else
            detail::product_rows<T, 1>(rows, row, here, panel, depth, 0, finish, Counts{});
    });
}

/// `count` rows times a packed matrix of `columns` columns. Vectors go up to the column where they cover all.
template <typename T, typename Rows, typename Finish>
inline void product(const Rows& rows, std::ptrdiff_t count, const PackedMatrix<T>& right,
                    std::ptrdiff_t columns, const Finish& finish) {
    for (std::ptrdiff_t p = 0; p < right.panels(); ++p) {
        const auto first = p * panel_columns<T>;
        const int vectors = columns - first > lanes<T> ? panel_vectors : 1;
        panel_product<T>(rows, count, right.panel(p), right.depth(), vectors,
                         [&](std::ptrdiff_t row, std::ptrdiff_t column, const auto& sums) {
                             finish(row, first + column, sums);
                         });
    }
}

/// Calls use(row, column, vector) for every vector of a tile.
template <typename T, int R, int W, typename Use>
inline void for_each_sum(std::ptrdiff_t row, std::ptrdiff_t column, const Lanes<T> (&sums)[R][W],
                         const Use& use) {
#pragma GCC unroll 16
    for (int r = 0; r < R; ++r)
#pragma GCC unroll 4
        for (int w = 0; w < W; ++w) use(row + r, column + w * lanes<T>, sums[r][w]);
}

/// Stores sums, with a bias over the columns, in rows that have room for whole vectors.
template <typename T>
struct StoreBiased {
    T* to;
    std::ptrdiff_t pitch;
    const T* bias;  ///< padded

    template <int R, int W>
    void operator()(std::ptrdiff_t row, std::ptrdiff_t column, const Lanes<T> (&sums)[R][W]) const {
        for_each_sum<T>(row, column, sums, [this](std::ptrdiff_t r, std::ptrdiff_t c, Lanes<T> sum) {
            store(to + r * pitch + c, sum + load(bias + c));
        });
    }
};

template <typename T>
struct StorePlain {
    T* to;
    std::ptrdiff_t pitch;

    template <int R, int W>
    void operator()(std::ptrdiff_t row, std::ptrdiff_t column, const Lanes<T> (&sums)[R][W]) const {
        for_each_sum<T>(row, column, sums, [this](std::ptrdiff_t r, std::ptrdiff_t c, Lanes<T> sum) {
            store(to + r * pitch + c, sum);
        });
    }
};

/// Stores sums in rows of exactly `columns` numbers.
template <typename T>
struct StoreExact {
    T* to;
    std::ptrdiff_t pitch, columns;

    template <int R, int W>
    void operator()(std::ptrdiff_t row, std::ptrdiff_t column, const Lanes<T> (&sums)[R][W]) const {
        for_each_sum<T>(row, column, sums, [this](std::ptrdiff_t r, std::ptrdiff_t c, Lanes<T> sum) {
            T* at = to + r * pitch + c;
            columns - c >= lanes<T> ? store(at, sum) : store_part(at, sum, columns - c);
        });
    }
};

/// Stores sums, a bias and what `from` holds in rows of exactly `columns` numbers; `to` may be `from`.
template <typename T>
struct StoreAdded {
    const T* from;
    T* to;
    std::ptrdiff_t pitch, columns;
    const T* bias;  ///< padded

    template <int R, int W>
    void operator()(std::ptrdiff_t row, std::ptrdiff_t column, const Lanes<T> (&sums)[R][W]) const {
        for_each_sum<T>(row, column, sums, [this](std::ptrdiff_t r, std::ptrdiff_t c, Lanes<T> sum) {
            const auto at = r * pitch + c, here = columns - c;
            sum += load(bias + c);
            if (here >= lanes<T>)
                store(to + at, load(from + at) + sum);
            else
                store_part(to + at, load_part(from + at, here) + sum, here);
        });
    }
};

namespace detail {

template <typename T, int R>
inline void outer_tile(const T* left, std::ptrdiff_t left_pitch, const T* right, std::ptrdiff_t depth,
                       T* sums, std::ptrdiff_t pitch) {
    Lanes<T> sum[R][panel_vectors];
#pragma GCC unroll 16
    for (int r = 0; r < R; ++r)
#pragma GCC unroll 4
        for (int w = 0; w < panel_vectors; ++w) sum[r][w] = Lanes<T>{};
    for (std::ptrdiff_t d = 0; d < depth; ++d, left += left_pitch, right += panel_columns<T>) {
        Lanes<T> columns[panel_vectors];
#pragma GCC unroll 4
        for (int w = 0; w < panel_vectors; ++w) columns[w] = load(right + w * lanes<T>);
#pragma GCC unroll 16
        for (int r = 0; r < R; ++r) {
            const T factor = left[r];
#pragma GCC unroll 4
            for (int w = 0; w < panel_vectors; ++w) sum[r][w] += factor * columns[w];
        }
    }
#pragma GCC unroll 16
    for (int r = 0; r < R; ++r)
#pragma GCC unroll 4
        for (int w = 0; w < panel_vectors; ++w) {
            T* at = sums + r * pitch + w * lanes<T>;
            store(at, load(at) + sum[r][w]);
        }
}

template <typename T, int... Counts>
inline void outer_rows(int count, const T* left, std::ptrdiff_t left_pitch, const T* right,
                       std::ptrdiff_t depth, T* sums, std::ptrdiff_t pitch,
                       std::integer_sequence<int, Counts...> /*counts*/) {
    ((count == Counts + 1 ? outer_tile<T, Counts + 1>(left, left_pitch, right, depth, sums, pitch) : void()),
     ...);
}

}  // namespace detail

/// sums (m, columns padded to whole panels; rows `pitch` apart) += the sum over `count` rows of left's m numbers times
/// right's. `panel` is room for count x panel_columns numbers.
template <typename T, typename RightRow>
inline void add_outer_products(const T* left, std::ptrdiff_t left_pitch, std::ptrdiff_t m,
                               const RightRow& right, std::ptrdiff_t columns, std::ptrdiff_t count, T* panel,
                               T* sums, std::ptrdiff_t pitch) {
    using Counts = std::make_integer_sequence<int, most_rows>;
    for (std::ptrdiff_t first = 0; first < columns; first += panel_columns<T>) {
        const auto here = std::min(panel_columns<T>, columns - first);
        for (std::ptrdiff_t row = 0; row < count; ++row) {
            T* to = panel + row * panel_columns<T>;
            const T* from = right(row) + first;
#pragma GCC unroll 4
            for (int w = 0; w < panel_vectors; ++w) {
                const auto left_over = here - w * lanes<T>;
                store(to + w * lanes<T>, left_over >= lanes<T> ? load(from + w * lanes<T>)
                                         : left_over > 0       ? load_part(from + w * lanes<T>, left_over)
                                                               : Lanes<T>{});
            }
        }
        detail::for_even_tiles(m, [&](std::ptrdiff_t row, int tile) {
            detail::outer_rows<T>(tile, left + row, left_pitch, panel, count, sums + row * pitch + first,
                                  pitch, Counts{});
        });
    }
}

/// Numbers a row of sums has for add_outer_products.
template <typename T>
constexpr std::ptrdiff_t panel_padded(std::ptrdiff_t columns) {
    return (columns + panel_columns<T> - 1) / panel_columns<T> * panel_columns<T>;
}

}  // namespace actformer::model::cpu
