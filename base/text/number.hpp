// Fast reading of decimal numbers in text: nearly all bytes of raw motion capture are numbers.
#pragma once

#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <system_error>

namespace actformer {

/// Reads the number that starts at `p`: a sign or none, digits with a point or none, an exponent or none, as in
/// "-12.5e-3", "+.5", "7". Returns where it ends, or nullptr where none starts there or it overflows a
/// double; "nan" and "inf" are no numbers. `value` is the nearest double, and is unchanged on failure. Blanks
/// before the number are not skipped, and what follows it is for the caller to judge. The text must end in a
/// byte that cannot be part of a number, with 8 more readable bytes after it.
inline const char* parse_number(const char* p, double& value);

namespace detail {

static_assert(std::endian::native == std::endian::little,
              "the first character must be the lowest byte of a word");

inline constexpr double powers_of_ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                           1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                           1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
inline constexpr std::uint32_t whole_powers_of_ten[16] = {1,      10,      100,      1000,     10000,
                                                          100000, 1000000, 10000000, 100000000};

/// Appends the digits at `p` to `mantissa` (modulo 2^64), eight at a time, and returns where they end.
inline const char* read_digits(const char* p, std::uint64_t& mantissa) {
    for (;;) {
        std::uint64_t bytes;
        std::memcpy(&bytes, p, 8);
        bytes ^= 0x3030303030303030;  // a digit's byte is now its value, any other is above 9
        // The lowest set bit 7 marks the first byte above 9. Carries reach only the bytes after it.
        const std::uint64_t others = (bytes | (bytes + 0x7676767676767676)) & 0x8080808080808080;
        const int count = std::countr_zero(others) / 8;
        // Up to the top, so that zeros lead; in two steps, as 64 bits at once may not be shifted.
        bytes = (bytes << (4 * (8 - count))) << (4 * (8 - count));
        // Neighbours join into numbers of 2, then 4, then 8 digits, the lower byte counting for more.
        bytes = (bytes * 10 + (bytes >> 8)) & 0x00FF00FF00FF00FF;
        bytes = (bytes * 100 + (bytes >> 16)) & 0x0000FFFF0000FFFF;
        bytes = (bytes * 10000 + (bytes >> 32)) & 0x00000000FFFFFFFF;
        mantissa = mantissa * whole_powers_of_ten[count] + bytes;
        p += count;
        if (count < 8) return p;
    }
}

/// `first`..`last` are an unsigned number's characters. One too small for a double becomes 0; false for one too large.
inline bool convert_slowly(const char* first, const char* last, bool below_one, double& magnitude) {
    const auto result = std::from_chars(first, last, magnitude);
    if (result.ec == std::errc::result_out_of_range && below_one) magnitude = 0;
    return result.ec == std::errc() || (result.ec == std::errc::result_out_of_range && below_one);
}

/// The exponent's value where one starts at `p` (at its e), moving `p` past it; else 0, leaving `p`.
inline std::int64_t read_exponent(const char*& p) {
    const char* q = p + 1;
    const bool negative = *q == '-';
    q += negative || *q == '+';
    if (*q < '0' || *q > '9') return 0;
    std::int64_t exponent = 0;
    for (; *q >= '0' && *q <= '9'; ++q)
        if (exponent < 1'000'000'000) exponent = exponent * 10 + (*q - '0');
    p = q;
    return negative ? -exponent : exponent;
}

}  // namespace detail

inline const char* parse_number(const char* p, double& value) {
    const bool negative = *p == '-';
    p += negative || *p == '+';
    const char* const first = p;
    std::uint64_t mantissa = 0;
    p = detail::read_digits(p, mantissa);
    std::int64_t digits = p - first, exponent = 0;
    if (*p == '.') {
        const char* const fraction = p + 1;
        p = detail::read_digits(fraction, mantissa);
        exponent = fraction - p;
        digits -= exponent;
    }
    if (digits == 0) return nullptr;
    if ((*p | 0x20) == 'e') exponent += detail::read_exponent(p);

    // Mantissa and power are exact in a double, so that one operation rounds once: to the nearest.
    double magnitude;
    if (digits <= 19 && mantissa <= (std::uint64_t{1} << 53) && exponent >= -22 && exponent <= 22) {
        const auto whole = static_cast<double>(mantissa);
        magnitude =
            exponent < 0 ? whole / detail::powers_of_ten[-exponent] : whole * detail::powers_of_ten[exponent];
    } else if (!detail::convert_slowly(first, p, exponent + digits <= 0, magnitude)) {
        return nullptr;
    }
    value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(magnitude) | (std::uint64_t{negative} << 63));
    return p;
}

}  // namespace actformer
