// Matrix products for the networks' inner loops: rows that lie anywhere times packed weights, and sums of outer products.
//
// Tiles have up to 12 rows by two vectors. What becomes of a tile's sums is the caller's: they are handed over vector by
// vector, so that a bias, a residual or a sum over nodes costs no pass of its own.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "model/cpu/product_tiles.hpp"

namespace actformer::model::cpu {

/// Vectors of a panel.
constexpr int panel_vectors = 2;

template <typename T>
constexpr std::ptrdiff_t panel_columns = panel_vectors* lanes<T>;

constexpr int most_rows = tile_registers / panel_vectors;

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

/// Hands take(row, column, sums) the sums of R rows times W vectors of a panel.
template <typename T, int R, int W, typename Tile, typename Take>
inline void product_tile(const Tile& left, const T* right, std::ptrdiff_t depth, std::ptrdiff_t row,
                         std::ptrdiff_t column, const Take& take) {
    alignas(vector_bytes) Lanes<T> sum[R][W];  // deduced types of vectors lose the loose alignment
    multiply_tile<T, R, W>(left, right, panel_columns<T>, depth, sum);
    take(row, column, sum);
}

template <typename T, int W, typename Rows, typename Take, int... Counts>
inline void product_rows(const Rows& rows, std::ptrdiff_t row, int count, const T* panel,
                         std::ptrdiff_t depth, std::ptrdiff_t column, const Take& take,
                         std::integer_sequence<int, Counts...> /*counts*/) {
    ((count == Counts + 1 ? product_tile<T, Counts + 1, W>(rows.template tile<Counts + 1>(row), panel, depth,
                                                           row, column, take)
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

/// Rows times one panel of `vectors` vectors: take(row, column, sums[R][W]) takes the sums of the R rows from `row` on,
/// columns counted from the panel's.
template <typename T, typename Rows, typename Take>
inline void panel_product(const Rows& rows, std::ptrdiff_t count, const T* panel, std::ptrdiff_t depth,
                          int vectors, const Take& take) {
    using Counts = std::make_integer_sequence<int, most_rows>;
    detail::for_even_tiles(count, [&](std::ptrdiff_t row, int here) {
        if (vectors == panel_vectors)
            detail::product_rows<T, panel_vectors>(rows, row, here, panel, depth, 0, take, Counts{});
        else
            detail::product_rows<T, 1>(rows, row, here, panel, depth, 0, take, Counts{});
    });
}

/// `count` rows times a packed matrix of `columns` columns. Vectors go up to the column where they cover all.
template <typename T, typename Rows, typename Take>
inline void product(const Rows& rows, std::ptrdiff_t count, const PackedMatrix<T>& right,
                    std::ptrdiff_t columns, const Take& take) {
    for (std::ptrdiff_t p = 0; p < right.panels(); ++p) {
        const auto first = p * panel_columns<T>;
        const int vectors = columns - first > lanes<T> ? panel_vectors : 1;
        panel_product<T>(rows, count, right.panel(p), right.depth(), vectors,
                         [&](std::ptrdiff_t row, std::ptrdiff_t column, const auto& sums) {
                             take(row, first + column, sums);
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

/// A row of the product's left side is a column of the numbers in memory.
template <typename T>
struct Columns {
    const T* first;
    std::ptrdiff_t pitch;
    T at(int r, std::ptrdiff_t d) const { return first[d * pitch + r]; }
};

template <typename T, int R>
inline void outer_tile(const T* left, std::ptrdiff_t left_pitch, const T* right, std::ptrdiff_t depth,
                       T* sums, std::ptrdiff_t pitch) {
    alignas(vector_bytes) Lanes<T> sum[R][panel_vectors];
    multiply_tile<T, R, panel_vectors>(Columns<T>{left, left_pitch}, right, panel_columns<T>, depth, sum);
    add_tile<T, R, panel_vectors>(sum, sums, pitch);
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
