// Rows of numbers of which dropout leaves some.
#pragma once

#include "model/cpu/random_kernel.hpp"
#include "model/cpu/vectors.hpp"

namespace actformer::model::cpu {

/// What stays of rows that lie one after the other, and by what it grows. Without bits all of it stays as it is.
template <typename T>
struct KeptRows {
    const std::uint16_t* bits = nullptr;
    std::int64_t words = 0;  ///< a row
    T scale = 1;

    explicit operator bool() const { return bits != nullptr; }

    /// The numbers of row `row` from column `column` on, a multiple of lanes<T>.
    Lanes<T> of(Lanes<T> x, std::int64_t row, std::int64_t column) const {
        const auto word = static_cast<unsigned>(bits[row * words + column / numbers_a_word]);
#if defined(__AVX512F__)
        if constexpr (std::is_same_v<T, float>)
            return Lanes<T>(
                _mm512_maskz_mul_ps(static_cast<__mmask16>(word), __m512(x), _mm512_set1_ps(scale)));
#endif
        const auto first = word >> (column % numbers_a_word);
        for (std::ptrdiff_t i = 0; i < lanes<T>; ++i) x[i] = first >> i & 1 ? x[i] * scale : T(0);
        return x;
    }

    /// The scale, or 0, of a single number.
    T share(std::int64_t row, std::int64_t column) const {
        if (!bits) return 1;
        const auto word = static_cast<unsigned>(bits[row * words + column / numbers_a_word]);
        return word >> (column % numbers_a_word) & 1 ? scale : T(0);
    }
};

/// Of `rows` rows of the batch's sample `sample`, in the thread's memory for `purpose`.
template <typename T, typename Memory>
KeptRows<T> kept_rows(const Dropout& dropout, std::int64_t sample, std::int64_t rows, std::int64_t columns,
                      const Memory& memory) {
    if (!dropout.drops()) return {};
    const auto words = words_for(columns);
    std::uint16_t* bits = memory(rows * words);
    draw_kept(dropout, sample, rows * words, bits);
    return {bits, words, static_cast<T>(dropout.scale())};
}

}  // namespace actformer::model::cpu
