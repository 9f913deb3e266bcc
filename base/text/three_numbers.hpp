// Fast reading of three numbers at the beginning of a line: a joint's position in raw motion capture.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

#include "base/text/number.hpp"

#if defined(__AVX512VBMI__) && defined(__AVX512BW__) && defined(__AVX512DQ__) && defined(__AVX512VL__) && \
    defined(__BMI2__)
#include <immintrin.h>
#define ACTFORMER_THREE_AT_ONCE
#endif

namespace actformer {

/// Three coordinates, and a spare value so that vector units can store all at once.
using Point = std::array<double, 4>;

namespace detail {

/// A product with one of these sets the point and the sign: [minus][digits behind the point].
inline constexpr double scales[2][16] = {{1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8},
                                         {-1, -1e-1, -1e-2, -1e-3, -1e-4, -1e-5, -1e-6, -1e-7, -1e-8}};

/// One to eight digits behind the point, in `length` characters. Returns nonzero, and any value, for another number: it does
/// not branch, and is fast for that. Needs 10 readable bytes.
inline std::uint64_t read_plain_number(const char* p, int length, double& value) {
    const auto minus = (static_cast<std::uint32_t>(static_cast<unsigned char>(*p) ^ '-') - 1U) >> 31;
    p += minus;
    const auto places = static_cast<std::uint32_t>(length - 2) - minus;
    const auto lead = static_cast<std::uint32_t>(static_cast<unsigned char>(*p)) - '0';
    std::uint64_t digits;
    std::memcpy(&digits, p + 2, 8);
    digits = (digits ^ 0x3030303030303030)
             << ((64 - 8 * places) & 63);  // what is no digit of ours leaves at the top
    const std::uint64_t odd = ((digits | (digits + 0x7676767676767676)) & 0x8080808080808080) |
                              static_cast<std::uint64_t>(places - 1 > 7) |
                              static_cast<std::uint64_t>(lead > 9) | static_cast<std::uint64_t>(p[1] != '.');
    // Neighbours join into numbers of 2, 4, then 8 digits, the lower byte counting for more.
    digits = (digits * (1 + (10ULL << 8)) >> 8) & 0x00FF00FF00FF00FF;
    digits = (digits * (1 + (100ULL << 16)) >> 16) & 0x0000FFFF0000FFFF;
    digits = digits * (1 + (10000ULL << 32)) >> 32;
    const auto whole = std::uint64_t{lead} * whole_powers_of_ten[places & 15] + digits;
    value = static_cast<double>(static_cast<std::int64_t>(whole)) * scales[minus][places & 15];
    return odd;
}

}  // namespace detail

/// Where the first three fields begin and end; false where fewer end here.
inline bool find_three(std::uint64_t blank, std::array<std::pair<int, int>, 3>& fields) {
    auto begins = ~blank & (blank << 1 | 1), ends = blank & ~(blank << 1 | 1);
    for (auto& field : fields) {
        field = {std::countr_zero(begins), std::countr_zero(ends)};
        begins &= begins - 1;
        if (ends == 0) return false;
        ends &= ends - 1;
    }
    return true;
}

/// read_three_plainly for any machine. Needs 10 readable bytes behind the 64.
inline bool read_three_one_by_one(const char* p, std::uint64_t blank, Point& values) {
    std::array<std::pair<int, int>, 3> fields;
    if (!find_three(blank, fields)) return false;
    std::uint64_t odd = 0;
    for (std::size_t d = 0; d < 3; ++d)
        odd |= detail::read_plain_number(p + fields[d].first, fields[d].second - fields[d].first, values[d]);
    return odd == 0;
}

#ifdef ACTFORMER_THREE_AT_ONCE

namespace detail {

/// Where three numbers stand in 64 characters, each with one digit before its point.
struct PlainDigits {
    std::uint64_t slots;   ///< of 16 bits a number, as many as it has digits
    std::uint32_t points;  ///< of 8 bits a number, where its point is
    __mmask8 minus;        ///< a bit a number
};

inline unsigned first_of(std::uint64_t mask) {
    return static_cast<unsigned>(std::countr_zero(mask));
}

inline bool find_plain_digits(__m512i less_0, std::uint64_t blank, PlainDigits& found) {
    const std::uint64_t digit = _mm512_cmplt_epu8_mask(less_0, _mm512_set1_epi8(10));
    const std::uint64_t dot = _mm512_cmpeq_epi8_mask(less_0, _mm512_set1_epi8('.' - '0'));
    const std::uint64_t minus = _mm512_cmpeq_epi8_mask(less_0, _mm512_set1_epi8('-' - '0'));
    const std::uint64_t behind_blank = blank << 1 | 1;
    const std::uint64_t end_1 = blank & ~behind_blank, end_2 = end_1 & (end_1 - 1),
                        end_3 = end_2 & (end_2 - 1);
    const std::uint64_t region = (end_3 - 1) & ~end_3;  // up to the third end
    const std::uint64_t begins = ~blank & behind_blank & region;
    const std::uint64_t minuses = minus & begins, leads = begins + minuses;  // the sum steps over a minus
    const std::uint64_t dot_1 = dot & region, dot_2 = dot_1 & (dot_1 - 1), dot_3 = dot_2 & (dot_2 - 1);
    const auto at_1 = first_of(dot_1), at_2 = first_of(dot_2), at_3 = first_of(dot_3);
    found.points = at_1 | at_2 << 8 | at_3 << 16;
    // One digit before the point, the rest behind.
    found.slots = _bzhi_u64(0xFFFF, first_of(end_1) - at_1) |
                  _bzhi_u64(0xFFFF, first_of(end_2) - at_2) << 16 |
                  _bzhi_u64(0xFFFF, first_of(end_3) - at_3) << 32;
    found.minus = static_cast<__mmask8>(_pext_u64(minuses, begins));
    const std::uint64_t odd =
        (leads ^ dot_1 >> 1) | (leads & ~digit) | ((region & ~(digit | dot | blank)) ^ minuses);
    return end_3 != 0 && odd == 0 && std::popcount(digit & region) == std::popcount(found.slots);
}

/// Byte i is of(i).
template <typename Of>
inline __m512i bytes_of(Of of) {
    std::array<std::int8_t, 64> bytes;
    for (int i = 0; i < 64; ++i) bytes[static_cast<std::size_t>(i)] = static_cast<std::int8_t>(of(i));
    return _mm512_loadu_si512(bytes.data());
}

}  // namespace detail

/// read_three_plainly with vectors of 64 characters; up to fifteen digits behind the point.
inline bool read_three_at_once(const char* p, std::uint64_t blank, Point& values) {
    const __m512i less_0 = _mm512_sub_epi8(_mm512_loadu_si512(p), _mm512_set1_epi8('0'));
    detail::PlainDigits found;
    if (!detail::find_plain_digits(less_0, blank, found)) return false;
    // 16 characters a number, zeros behind its digits, so that all have their points at the same place. The first digit
    // stands one before the point, the others behind.
    const __m512i number = detail::bytes_of([](int i) { return i / 16; });
    const __m512i from_point = detail::bytes_of([](int i) { return i % 16 == 0 ? -1 : i % 16; });
    const __m512i points = _mm512_shuffle_epi8(_mm512_set1_epi32(static_cast<int>(found.points)), number);
    const __m512i digits =
        _mm512_maskz_permutexvar_epi8(found.slots, _mm512_add_epi8(points, from_point), less_0);
    // Neighbours join into numbers of 2, 4, then 8 digits, the lower one counting for more.
    const __m512i twos = _mm512_maddubs_epi16(digits, _mm512_set1_epi16(10 | 1 << 8));
    const __m512i fours = _mm512_madd_epi16(twos, _mm512_set1_epi32(100 | 1 << 16));
    const __m512i eights =
        _mm512_add_epi64(_mm512_mul_epu32(fours, _mm512_set1_epi64(10000)), _mm512_srli_epi64(fours, 32));
    const __m512d scale = _mm512_setr_pd(1e-7, 1e-15, 1e-7, 1e-15, 1e-7, 1e-15, 1e-7, 1e-15);
    const __m512d halves = _mm512_mul_pd(_mm512_cvtepi64_pd(eights), scale);
    const __m512d sums = _mm512_add_pd(halves, _mm512_permute_pd(halves, 0x55));
    const __m256d magnitudes =
        _mm512_castpd512_pd256(_mm512_permutexvar_pd(_mm512_setr_epi64(0, 2, 4, 6, 0, 2, 4, 6), sums));
    _mm256_storeu_pd(values.data(),
                     _mm256_mask_xor_pd(magnitudes, found.minus, magnitudes, _mm256_set1_pd(-0.0)));
    return true;
}

#endif

/// Reads the first three of the fields that stand in the 64 characters at `p`, of which `blank` says which are blank,
/// where they are written as sensors nearly always write them: [-]D.DDDDDDDD. False, with any values, for other
/// fields, however sound. Values may be off by the last bit or two of a double, which float32 limbs never see.
inline bool read_three_plainly(const char* p, std::uint64_t blank, Point& values) {
#ifdef ACTFORMER_THREE_AT_ONCE
    return read_three_at_once(p, blank, values);
#else
    return read_three_one_by_one(p, blank, values);
#endif
}

}  // namespace actformer
