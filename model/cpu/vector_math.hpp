// Elementary functions of whole vectors: float within some 1e-7, double as the library has them.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "model/cpu/vectors.hpp"

namespace actformer::model::cpu {

using Floats = Lanes<float>;
using Doubles = Lanes<double>;
typedef std::int32_t Bits __attribute__((vector_size(vector_bytes)));

/// min(x, bound); NaN where x is.
inline Floats smaller(Floats x, Floats bound) {
    return bound < x ? bound : x;
}

/// max(x, bound); NaN where x is.
inline Floats larger(Floats x, Floats bound) {
    return bound > x ? bound : x;
}

inline Floats magnitude(Floats x) {
    return Floats(Bits(x) & 0x7FFFFFFF);
}

/// 1/x within some 1e-8 of it, without a division's wait.
inline Floats reciprocal(Floats x) {
#if defined(__AVX512F__)
    const auto near = Floats(_mm512_maskz_rcp14_ps(0xFFFF, __m512(x)));
    return near * (2.0F - x * near);
#else
    return 1.0F / x;
#endif
}

/// e^x for x up to 88; next to nothing below -87; NaN where x is.
inline Floats exponential(Floats x) {
    x = smaller(larger(x, Floats{} - 87.0F), Floats{} + 88.0F);
    constexpr float shift =
        12582912.0F;  // 1.5 * 2^23: adding it leaves the nearest whole number in the lowest bits
    const Floats shifted = x * 1.44269504F + shift;
    const Floats n = shifted - shift;
    const Floats f = (x - n * 0.693359375F) + n * 2.12194440e-4F;  // ln 2 in two parts
    Floats p = f * 1.9875691500e-4F + 1.3981999507e-3F;
    p = p * f + 8.3334519073e-3F;
    p = p * f + 4.1665795894e-2F;
    p = p * f + 1.6666665459e-1F;
    p = p * f + 5.0000001201e-1F;
    p = p * f * f + f + 1.0F;
    return Floats(Bits(p) + (Bits(shifted) << 23));
}

inline Floats hyperbolic_tangent(Floats x) {
    const Floats size = magnitude(x), square = x * x;
    Floats p = square * -5.70498872745e-3F + 2.06390887954e-2F;  // near 0 an odd polynomial keeps the digits
    p = p * square - 5.37397155531e-2F;
    p = p * square + 1.33314422036e-1F;
    p = p * square - 3.33332819422e-1F;
    const Floats near = x + x * square * p;
    const Floats far = 1.0F - 2.0F * reciprocal(exponential(2.0F * size) + 1.0F);
    return size < 0.625F ? near : x < 0.0F ? -far : far;
}

/// The natural logarithm of positive numbers.
inline Floats logarithm(Floats x) {
    Bits exponent = (Bits(x) >> 23) - 126;
    Floats m = Floats((Bits(x) & 0x007FFFFF) | 0x3F000000);  // in [0.5, 1)
    const auto low = m < 0.707106781F;
    exponent += Bits(low);  // comparisons give -1
    m = (low ? m + m : m) - 1.0F;
    const Floats square = m * m;
    Floats p = m * 7.0376836292e-2F - 1.1514610310e-1F;
    p = p * m + 1.1676998740e-1F;
    p = p * m - 1.2420140846e-1F;
    p = p * m + 1.4249322787e-1F;
    p = p * m - 1.6668057665e-1F;
    p = p * m + 2.0000714765e-1F;
    p = p * m - 2.4999993993e-1F;
    p = p * m + 3.3333331174e-1F;
    const Floats e = __builtin_convertvector(exponent, Floats);
    return (p * m * square - e * 2.12194440e-4F - 0.5F * square) + m + e * 0.693359375F;
}

struct Turn {
    Floats cosine, sine;
};

/// Of the angle that is `x` of a whole turn, x in [0, 1].
inline Turn turned(Floats x) {
    constexpr float shift = 12582912.0F;
    const Floats shifted = x * 4.0F + shift, quarters = shifted - shift;
    const Bits quarter = Bits(shifted);
    const Floats angle = (x - quarters * 0.25F) * 6.28318530718F,
                 square = angle * angle;  // within an eighth of a turn
    Floats s = square * -1.9515295891e-4F + 8.3321608736e-3F;
    s = s * square - 1.6666654611e-1F;
    s = s * square * angle + angle;
    Floats c = square * 2.443315711809948e-5F - 1.388731625493765e-3F;
    c = c * square + 4.166664568298827e-2F;
    c = c * square * square - 0.5F * square + 1.0F;
    const auto odd = (quarter & 1) != 0;
    const Floats cosine = odd ? -s : c, sine = odd ? c : s;
    const auto back = (quarter & 2) != 0;
    return {back ? -cosine : cosine, back ? -sine : sine};
}

inline Floats root(Floats x) {
#if defined(__AVX512F__)
    return Floats(_mm512_maskz_sqrt_ps(0xFFFF, __m512(x)));
#else
    for (std::ptrdiff_t i = 0; i < lanes<float>; ++i) x[i] = std::sqrt(x[i]);
    return x;
#endif
}

/// x times the chance that a normal number is below x, and its slope.
template <typename T>
struct Gelu {
    Lanes<T> value, slope;
};

/// The chance by Hastings' rational approximation, which shares its exponential with the density: within 1e-7.
inline Gelu<float> gelu(Floats x) {
    const Floats bell = exponential(-0.5F * x * x);
    const Floats t = reciprocal(magnitude(x) * 0.2316418882663604F + 1.0F);
    Floats p = t * (0.5F * 1.061405429F) - 0.5F * 1.453152027F;
    p = p * t + 0.5F * 1.421413741F;
    p = p * t - 0.5F * 0.284496736F;
    p = p * t + 0.5F * 0.254829592F;
    const Floats beyond = p * t * bell;
    const Floats chance = x < 0.0F ? beyond : 1.0F - beyond;
    return {x * chance, chance + x * bell * 0.3989422804F};
}

template <typename Function>
inline Doubles each(Doubles x, const Function& function) {
    Doubles out = x;
    for (std::ptrdiff_t i = 0; i < lanes<double>; ++i) out[i] = function(x[i]);
    return out;
}

inline Doubles root(Doubles x) {
    return each(x, [](double v) { return std::sqrt(v); });
}

inline Doubles exponential(Doubles x) {
    return each(x, [](double v) { return std::exp(v); });
}

inline Doubles hyperbolic_tangent(Doubles x) {
    return each(x, [](double v) { return std::tanh(v); });
}

inline Gelu<double> gelu(Doubles x) {
    const Doubles chance = each(x, [](double v) { return 0.5 * std::erfc(-v * 0.70710678118654752); });
    const Doubles bell = exponential(-0.5 * x * x);
    return {x * chance, chance + x * bell * 0.39894228040143268};
}

}  // namespace actformer::model::cpu
