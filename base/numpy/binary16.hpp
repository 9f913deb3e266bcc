// Numbers of two bytes.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace actformer {

/// What the bits of an IEEE 754 binary16 stand for.
inline double of_binary16(std::uint16_t bits) {
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double magnitude = exponent == 0    ? std::ldexp(fraction, -24)
                             : exponent == 31 ? (fraction ? std::numeric_limits<double>::quiet_NaN()
                                                          : std::numeric_limits<double>::infinity())
                                              : std::ldexp(1024 + fraction, exponent - 25);
    return bits >> 15 ? -magnitude : magnitude;
}

}  // namespace actformer
