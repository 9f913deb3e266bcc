// Matrix products over the rows of motions, (T, K, C) with channels last: the inner loops of the recogniser on processors.
//
// A row is one joint in one frame. Rows lie `frame` numbers apart from one frame to the next and `row` apart from one joint to
// the next, so that a temporal convolution's tap, or every other frame, is the same product from another first row.
//
// Right-hand matrices are packed in panels of up to 4 vectors of columns, cut in depth: a panel stays in the first-level cache while all
// rows of a sample pass over it, and float32's rounding grows with the square root of 32, a cut's depth, not of all that is
// summed. For the same reason a tile sums from zero and joins what is there once, at its end.
#pragma once

#include <algorithm>
#include <vector>

#include "model/cpu/product_tiles.hpp"

namespace actformer::model::cpu {

/// Rows in memory.
template <typename T>
struct Rows {
    T* first = nullptr;
    std::ptrdiff_t frame = 0, row = 0;

    T* at(std::ptrdiff_t t, std::ptrdiff_t k) const { return first + t * frame + k * row; }
    Rows from(std::ptrdiff_t t) const { return {first + t * frame, frame, row}; }
};

/// A matrix (depth, columns) packed for products; columns a multiple of lanes<T>.
template <typename T>
class Panels {
  public:
    Panels() = default;
    /// `values` row-major (depth, columns), rows `stride` apart.
    Panels(const T* values, std::ptrdiff_t depth, std::ptrdiff_t columns, std::ptrdiff_t stride)
        : depth_(depth), columns_(columns), values_(static_cast<std::size_t>(depth * columns)) {
        T* to = values_.data();
        for (std::ptrdiff_t c = 0; c < columns; c += block_columns)
            for (std::ptrdiff_t d = 0; d < depth; ++d)
                to = std::copy_n(values + d * stride + c, std::min(block_columns, columns - c), to);
    }

    static constexpr std::ptrdiff_t block_columns = 4 * lanes<T>;
    std::ptrdiff_t depth() const { return depth_; }
    std::ptrdiff_t columns() const { return columns_; }
    /// Column block that starts at `column`, a multiple of block_columns: (depth, block) contiguous.
    const T* block(std::ptrdiff_t column) const { return values_.data() + column * depth_; }

  private:
    std::ptrdiff_t depth_ = 0, columns_ = 0;
    std::vector<T> values_;
};

namespace detail {

/// Rows anywhere in memory.
template <typename T, int R>
struct RowPointers {
    const T* row[R];
    T at(int r, std::ptrdiff_t d) const { return row[r][d]; }
};

/// c[r] += a[r] * b for `R` rows, W vectors wide.
template <typename T, int R, int W>
inline void add_rows(RowPointers<T, R> a, const T* b, std::ptrdiff_t depth, T* const* c) {
    alignas(vector_bytes) Lanes<T> sum[R][W];
    multiply_tile<T, R, W>(a, b, W * lanes<T>, depth, sum);
#pragma GCC unroll 16
    for (int r = 0; r < R; ++r)
#pragma GCC unroll 4
        for (int w = 0; w < W; ++w) store(c[r] + w * lanes<T>, load(c[r] + w * lanes<T>) + sum[r][w]);
}

/// All rows of a column block, a cut at a time. Rows missing in the last tile are stood for by a spare one.
template <typename T, int W>
void product_block(Rows<const T> a, const T* b, std::ptrdiff_t depth, Rows<T> c, std::ptrdiff_t frames,
                   std::ptrdiff_t joints) {
    constexpr int R = std::min(tile_registers / W, 12);
    constexpr std::ptrdiff_t cut = 32;
    T spare[W * lanes<T>] = {};
    for (std::ptrdiff_t d = 0; d < depth; d += cut) {
        const auto deep = std::min(cut, depth - d);
        RowPointers<T, R> left;
        T* out[R];
        int filled = 0;
        const auto flush = [&] {
            for (int r = filled; r < R; ++r) {
                left.row[r] = left.row[0];
                out[r] = spare;
            }
            add_rows<T, R, W>(left, b + d * W * lanes<T>, deep, out);
            filled = 0;
        };
        for (std::ptrdiff_t t = 0; t < frames; ++t)
            for (std::ptrdiff_t k = 0; k < joints; ++k) {
                left.row[filled] = a.at(t, k) + d;
                out[filled] = c.at(t, k);
                if (++filled == R) flush();
            }
        if (filled > 0) flush();
    }
}

/// sums (R rows of W vectors, rows `stride` apart) += for every row: R numbers of a times W vectors of g.
template <typename T, int R, int W>
inline void outer_tile(Rows<const T> a, Rows<const T> g, std::ptrdiff_t frames, std::ptrdiff_t joints,
                       T* sums, std::ptrdiff_t stride) {
    alignas(vector_bytes) Lanes<T> sum[R][W] = {};
    for (std::ptrdiff_t t = 0; t < frames; ++t) {
        const T *left = a.at(t, 0), *right = g.at(t, 0);
        for (std::ptrdiff_t k = 0; k < joints; ++k, left += a.row, right += g.row) {
            Lanes<T> column[W];
#pragma GCC unroll 4
            for (int w = 0; w < W; ++w) column[w] = load(right + w * lanes<T>);
#pragma GCC unroll 16
            for (int r = 0; r < R; ++r)
#pragma GCC unroll 4
                for (int w = 0; w < W; ++w) sum[r][w] += left[r] * column[w];
        }
    }
    add_tile<T, R, W>(sum, sums, stride);
}

template <typename T, int W>
void outer_block(Rows<const T> a, Rows<const T> g, std::ptrdiff_t frames, std::ptrdiff_t joints,
                 std::ptrdiff_t depth, T* sums, std::ptrdiff_t stride) {
    constexpr int most = tile_registers == 24 ? (W <= 2 ? 8 : 4) : (W == 1 ? 8 : W == 2 ? 4 : 2);
    constexpr int R = std::min<int>(most, lanes<T>);
    static_assert(lanes<T> % R == 0);  // and with it every padded depth
    for (std::ptrdiff_t d = 0; d < depth; d += R)
        outer_tile<T, R, W>({a.first + d, a.frame, a.row}, g, frames, joints, sums + d * stride, stride);
}

}  // namespace detail

/// c += a * b, for `frames` x `joints` rows.
template <typename T>
void add_product(Rows<const T> a, const Panels<T>& b, Rows<T> c, std::ptrdiff_t frames,
                 std::ptrdiff_t joints) {
    for (std::ptrdiff_t column = 0; column < b.columns(); column += Panels<T>::block_columns) {
        const Rows<T> out{c.first + column, c.frame, c.row};
        switch (std::min(Panels<T>::block_columns, b.columns() - column) / lanes<T>) {
            case 1:
                detail::product_block<T, 1>(a, b.block(column), b.depth(), out, frames, joints);
                break;
            case 2:
                detail::product_block<T, 2>(a, b.block(column), b.depth(), out, frames, joints);
                break;
            case 3:
                detail::product_block<T, 3>(a, b.block(column), b.depth(), out, frames, joints);
                break;
            default:
                detail::product_block<T, 4>(a, b.block(column), b.depth(), out, frames, joints);
        }
    }
}

/// sums (depth, columns), rows `stride` apart, += the sum over rows of a's `depth` numbers times g's `columns`; both multiples
/// of lanes<T>.
template <typename T>
void add_outer(Rows<const T> a, Rows<const T> g, std::ptrdiff_t frames, std::ptrdiff_t joints,
               std::ptrdiff_t depth, std::ptrdiff_t columns, T* sums, std::ptrdiff_t stride) {
    for (std::ptrdiff_t column = 0; column < columns; column += 4 * lanes<T>) {
        const Rows<const T> right{g.first + column, g.frame, g.row};
        switch (std::min(4 * lanes<T>, columns - column) / lanes<T>) {
            case 1:
                detail::outer_block<T, 1>(a, right, frames, joints, depth, sums + column, stride);
                break;
            case 2:
                detail::outer_block<T, 2>(a, right, frames, joints, depth, sums + column, stride);
                break;
            case 3:
                detail::outer_block<T, 3>(a, right, frames, joints, depth, sums + column, stride);
                break;
            default:
                detail::outer_block<T, 4>(a, right, frames, joints, depth, sums + column, stride);
        }
    }
}

}  // namespace actformer::model::cpu
