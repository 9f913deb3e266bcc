// The mean of repeated measurements and how far it may be off.
#pragma once

#include <optional>
#include <span>

namespace actformer::eval {

/// mean +- half_width is the 95 % confidence interval t s / sqrt(n), with s the standard deviation over n - 1 and t the
/// quantile of Student's distribution with n - 1 degrees of freedom: 2.093 for 20 repeats where papers often take the
/// normal distribution's 1.96, 4.303 for 3.
struct Interval {
    double mean = 0;
    std::optional<double> half_width;  ///< none for a single measurement
};

/// Of at least one value.
Interval interval(std::span<const double> values);

/// The same with the normal distribution's 1.96 in place of t, as papers have it.
Interval normal_interval(std::span<const double> values);

/// mean(b) - mean(a) of two samples that have nothing to do with one another and need not vary alike, with its 95 % confidence interval
/// (Welch, Biometrika 1947). Each of at least one value; no half-width where one has no more.
Interval difference(std::span<const double> a, std::span<const double> b);

/// The same where a[i] and b[i] belong together, as two generators' scores with one seed: the interval of b[i] - a[i]. As many of both.
Interval paired_difference(std::span<const double> a, std::span<const double> b);

/// t with P(|T| <= t) = 0.95 for `degrees` degrees of freedom, at least 1.
double student_95(std::size_t degrees);

}  // namespace actformer::eval
