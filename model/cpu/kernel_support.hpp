// What the kernels share: memory that threads keep from call to call, packing, sums over threads.
#pragma once

#include <omp.h>

#include <cstdint>
#include <vector>

#include "model/cpu/products.hpp"

namespace actformer::model::cpu {

/// Memory of the calling thread for one purpose, a type of the caller's own, kept from call to call. Good until the thread
/// asks for the same purpose again. What was never written is 0.
template <typename T, typename Purpose>
T* scratch(Purpose /*purpose*/, std::ptrdiff_t count) {
    thread_local std::vector<T> memory;
    if (memory.size() < static_cast<std::size_t>(count)) memory.resize(static_cast<std::size_t>(count));
    return memory.data();
}

/// The same of zeros.
template <typename T, typename Purpose>
T* zeroed_scratch(Purpose purpose, std::ptrdiff_t count) {
    T* memory = scratch<T>(purpose, count);
    std::fill_n(memory, count, T(0));
    return memory;
}

/// The same of a packed matrix.
template <typename T, typename Purpose>
PackedMatrix<T>& packed_scratch(Purpose /*purpose*/) {
    thread_local PackedMatrix<T> matrix;
    return matrix;
}

/// Packs a weight (out, in) so that rows of inputs times it give outputs.
template <typename T>
void pack_forward(PackedMatrix<T>& to, const T* weight, std::int64_t out, std::int64_t in, int threads) {
    to.resize(in, out);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t p = 0; p < to.panels(); ++p) to.fill_transposed(p, weight, in, out);
}

/// Packs a weight (out, in) so that rows of outputs' gradients times it give inputs'.
template <typename T>
void pack_backward(PackedMatrix<T>& to, const T* weight, std::int64_t out, std::int64_t in, int threads) {
    to.resize(out, in);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t p = 0; p < to.panels(); ++p) to.fill(p, weight, in, in);
}

/// A copy of `count` numbers with zeros behind, for loads of whole panels.
template <typename T, typename Purpose>
T* padded_copy(Purpose purpose, const T* from, std::int64_t count) {
    T* to = zeroed_scratch<T>(purpose, panel_padded<T>(count));
    std::copy_n(from, count, to);
    return to;
}

/// Threads' own sums of a gradient (rows, columns) with `pitch` numbers a row, added up thread after thread.
template <typename T>
class ThreadSums {
  public:
    ThreadSums(int threads, std::int64_t rows, std::int64_t columns)
        : ThreadSums(threads, rows, columns, rows) {}

    /// A thread's own have room for `own_rows`, of which the first `rows` are the gradient.
    ThreadSums(int threads, std::int64_t rows, std::int64_t columns, std::int64_t own_rows)
        : rows_(rows),
          columns_(columns),
          own_rows_(own_rows),
          pitch_(panel_padded<T>(columns)),
          sums_(static_cast<std::size_t>(threads)) {}

    std::int64_t pitch() const { return pitch_; }

    /// Called by every thread of a team before it adds.
    template <typename Purpose>
    T* own(Purpose purpose) {
        return sums_[static_cast<std::size_t>(omp_get_thread_num())] =
                   zeroed_scratch<T>(purpose, own_rows_ * pitch_);
    }

    /// Called by every thread of a team, behind a barrier.
    void write(T* to) const {
#pragma omp for schedule(static)
        for (std::int64_t r = 0; r < rows_; ++r) {
            T* row = to + r * columns_;
            std::fill_n(row, columns_, T(0));
            for (const T* sums : sums_)
                if (sums)  // fewer threads may have come than were asked for
                    for (std::int64_t c = 0; c < columns_; ++c) row[c] += sums[r * pitch_ + c];
        }
    }

  private:
    std::int64_t rows_, columns_, own_rows_, pitch_;
    std::vector<T*> sums_;
};

template <typename T>
inline void add_row(const T* from, std::int64_t count, T* to) {
#pragma omp simd
    for (std::int64_t i = 0; i < count; ++i) to[i] += from[i];
}

}  // namespace actformer::model::cpu
