// Tiles of matrix products: sums of R rows by W vectors that live in registers, as many as keep both multiplier ports busy while
// a row's number is broadcast and a few vectors of columns are read.
#pragma once

#include "model/cpu/vectors.hpp"

namespace actformer::model::cpu {

/// Registers for a tile's sums, and the rows that it has at most.
constexpr int tile_registers = vector_bytes == 64 ? 24 : 12;

/// sums = rows times columns: left.at(r, d) for d below `depth` times the W vectors that begin `step` numbers apart at `right`.
template <typename T, int R, int W, typename Left>
inline void multiply_tile(const Left& left, const T* right, std::ptrdiff_t step, std::ptrdiff_t depth,
                          Lanes<T> (&sums)[R][W]) {
#pragma GCC unroll 16
    for (int r = 0; r < R; ++r)
#pragma GCC unroll 4
        for (int w = 0; w < W; ++w) sums[r][w] = Lanes<T>{};
    for (std::ptrdiff_t d = 0; d < depth; ++d, right += step) {
        Lanes<T> columns[W];
#pragma GCC unroll 4
        for (int w = 0; w < W; ++w) columns[w] = load(right + w * lanes<T>);
#pragma GCC unroll 16
        for (int r = 0; r < R; ++r) {
            const T factor = left.at(r, d);
#pragma GCC unroll 4
            for (int w = 0; w < W; ++w) sums[r][w] += factor * columns[w];
        }
    }
}

/// Adds a tile to numbers in memory, rows `pitch` apart.
template <typename T, int R, int W>
inline void add_tile(const Lanes<T> (&sums)[R][W], T* to, std::ptrdiff_t pitch) {
#pragma GCC unroll 16
    for (int r = 0; r < R; ++r)
#pragma GCC unroll 4
        for (int w = 0; w < W; ++w) {
            T* at = to + r * pitch + w * lanes<T>;
            store(at, load(at) + sums[r][w]);
        }
}

}  // namespace actformer::model::cpu
