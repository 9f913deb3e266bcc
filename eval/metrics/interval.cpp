#include "eval/metrics/interval.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <vector>

namespace actformer::eval {

namespace {

double quantile_of(double degrees) {
    return boost::math::quantile(boost::math::complement(boost::math::students_t(degrees), 0.025));
}

double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Of the mean: s^2 / n.
double squared_error(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    const double mean = mean_of(values);
    double squares = 0;
    for (const double v : values) squares += (v - mean) * (v - mean);
    return squares / (n - 1) / n;
}

/// `quantile` of as many degrees of freedom as there are values beyond the first.
template <typename Quantile>
Interval interval_by(std::span<const double> values, const Quantile& quantile) {
    Interval out{mean_of(values), {}};
    if (values.size() > 1) out.half_width = quantile(values.size() - 1) * std::sqrt(squared_error(values));
    return out;
}

}  // namespace

double student_95(std::size_t degrees) {
    return quantile_of(static_cast<double>(degrees));
}

Interval interval(std::span<const double> values) {
    return interval_by(values, student_95);
}

Interval normal_interval(std::span<const double> values) {
    return interval_by(values, [](std::size_t) { return 1.96; });
}

Interval paired_difference(std::span<const double> a, std::span<const double> b) {
    std::vector<double> differences(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) differences[i] = b[i] - a[i];
    return interval(differences);
}

Interval difference(std::span<const double> a, std::span<const double> b) {
    Interval out{mean_of(b) - mean_of(a), {}};
    if (a.size() < 2 || b.size() < 2) return out;
    const double of_a = squared_error(a), of_b = squared_error(b), both = of_a + of_b;
    if (both == 0) {
        out.half_width = 0;
        return out;
    }
    const double degrees =
        both * both /
        (of_a * of_a / static_cast<double>(a.size() - 1) + of_b * of_b / static_cast<double>(b.size() - 1));
    out.half_width = quantile_of(degrees) * std::sqrt(both);
    return out;
}

}  // namespace actformer::eval
