#include "eval/metrics/interval.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace actformer::eval {

double student_95(std::size_t degrees) {
    const boost::math::students_t distribution(static_cast<double>(degrees));
    return boost::math::quantile(boost::math::complement(distribution, 0.025));
}

namespace {

/// `quantile` of as many degrees of freedom as there are values beyond the first.
template <typename Quantile>
Interval interval_by(std::span<const double> values, const Quantile& quantile) {
    const auto n = static_cast<double>(values.size());
    Interval out{std::accumulate(values.begin(), values.end(), 0.0) / n, {}};
    if (values.size() < 2) return out;
    double squares = 0;
    for (const double v : values) squares += (v - out.mean) * (v - out.mean);
    out.half_width = quantile(values.size() - 1) * std::sqrt(squares / (n - 1) / n);
    return out;
}

}  // namespace

Interval interval(std::span<const double> values) {
    return interval_by(values, student_95);
}

Interval normal_interval(std::span<const double> values) {
    return interval_by(values, [](std::size_t) { return 1.96; });
}

}  // namespace actformer::eval
