// Walking lines of blank-separated fields without looking at most of their characters one by one.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

#if defined(__AVX512BW__) || defined(__AVX2__) || defined(__SSE2__)
#include <immintrin.h>
#endif

namespace actformer {

/// Bit i says what text[i] is, of 64 characters.
struct CharacterMasks {
    std::uint64_t newline;
    std::uint64_t blank;  ///< a space or anything below, newlines and the zero bytes behind a text included
};

/// One character at a time: what the vector versions below must agree with.
inline CharacterMasks masks_of_64_plain(const char* p) {
    CharacterMasks masks{};
    for (int i = 0; i < 64; ++i) {
        masks.newline |= std::uint64_t{p[i] == '\n'} << i;
        masks.blank |= std::uint64_t{static_cast<unsigned char>(p[i]) <= ' '} << i;
    }
    return masks;
}

inline CharacterMasks masks_of_64(const char* p) {
#if defined(__AVX512BW__)
    const __m512i text = _mm512_loadu_si512(p);
    return {_mm512_cmpeq_epi8_mask(text, _mm512_set1_epi8('\n')),
            _mm512_cmple_epu8_mask(text, _mm512_set1_epi8(' '))};
#elif defined(__AVX2__)
    CharacterMasks masks{};
    for (int half = 0; half < 2; ++half) {
        const __m256i text = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p + 32 * half));
        const __m256i low =
            _mm256_cmpeq_epi8(_mm256_max_epu8(text, _mm256_set1_epi8(' ')), _mm256_set1_epi8(' '));
        const auto newline =
            static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_cmpeq_epi8(text, _mm256_set1_epi8('\n'))));
        masks.newline |= std::uint64_t{newline} << (32 * half);
        masks.blank |= std::uint64_t{static_cast<std::uint32_t>(_mm256_movemask_epi8(low))} << (32 * half);
    }
    return masks;
#elif defined(__SSE2__)
    CharacterMasks masks{};
    for (int part = 0; part < 4; ++part) {
        const __m128i text = _mm_loadu_si128(reinterpret_cast<const __m128i*>(p + 16 * part));
        const __m128i low = _mm_cmpeq_epi8(_mm_max_epu8(text, _mm_set1_epi8(' ')), _mm_set1_epi8(' '));
        const auto newline =
            static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_cmpeq_epi8(text, _mm_set1_epi8('\n'))));
        masks.newline |= std::uint64_t{newline} << (16 * part);
        masks.blank |= std::uint64_t{static_cast<std::uint32_t>(_mm_movemask_epi8(low))} << (16 * part);
    }
    return masks;
#else
    return masks_of_64_plain(p);
#endif
}

/// The end of the line that `p` is in, its newline or `end`, and in `fields` how many fields begin between. `p` stands
/// on a blank, on a line's first character, or at `end`. 64 bytes behind `end` must be readable.
inline const char* end_of_line(const char* p, const char* end, int& fields) {
    fields = 0;
    std::uint64_t after_blank = 1;
    for (; p < end; p += 64) {
        const auto masks = masks_of_64(p);
        std::uint64_t begins = ~masks.blank & (masks.blank << 1 | after_blank);
        if (end - p < 64) begins &= (std::uint64_t{1} << (end - p)) - 1;
        if (masks.newline) {
            const int at = std::countr_zero(masks.newline);
            if (p + at < end) {
                fields += std::popcount(begins & ((std::uint64_t{1} << at) - 1));
                return p + at;
            }
        }
        fields += std::popcount(begins);
        after_blank = masks.blank >> 63;
    }
    return end;
}

inline bool is_blank(char c) {
    return static_cast<unsigned char>(c) <= ' ' && c != '\n';
}

/// Past blanks, but not past the line's end.
inline const char* skip_blanks(const char* p, const char* end) {
    while (p < end && is_blank(*p)) ++p;
    return p;
}

/// Past a UTF-8 byte order mark.
inline std::string_view without_bom(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

}  // namespace actformer
