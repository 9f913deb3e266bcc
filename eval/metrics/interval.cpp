#include "eval/metrics/interval.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

namespace actformer::eval {
namespace {

/// P(|T| <= t): a finite sum for whole degrees of freedom (Abramowitz and Stegun 26.7.3 and 26.7.4).
double within(double t, std::size_t degrees) {
    const double angle = std::atan(t / std::sqrt(static_cast<double>(degrees)));
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const bool odd = degrees % 2 == 1;
    double term = odd ? cosine : 1, sum = 0;
    for (std::size_t k = odd ? 1 : 0; k + 2 <= degrees; k += 2) {
        sum += term;
        term *= cosine * cosine * static_cast<double>(k + 1) / static_cast<double>(k + 2);
    }
    return odd ? 2 / std::numbers::pi * (angle + sine * sum) : sine * sum;
}

}  // namespace

double student_95(std::size_t degrees) {
    double low = 1.9, high = 13;  // the normal distribution's 1.96 to 12.71 with one degree
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (within(middle, degrees) < 0.95 ? low : high) = middle;
    }
    return (low + high) / 2;
}

Interval interval(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    Interval out{std::accumulate(values.begin(), values.end(), 0.0) / n, {}};
    if (values.size() < 2) return out;
    double squares = 0;
    for (const double v : values) squares += (v - out.mean) * (v - out.mean);
    out.half_width = student_95(values.size() - 1) * std::sqrt(squares / (n - 1) / n);
    return out;
}

}  // namespace actformer::eval
