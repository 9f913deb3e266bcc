// Where each metric's value is among what scoring has measured.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "eval/metrics/metric.hpp"
#include "eval/scoring/scorer.hpp"

namespace actformer::eval {

/// Of the metric of this name. Either `of` or `of_motion` is there: the latter of what is measured of motions themselves, which is known of
/// each class too.
struct MetricValue {
    std::string_view name;
    std::optional<double> (*of)(const Score&) = nullptr;
    std::optional<double> MotionScore::*of_motion = nullptr;
};

/// One for every metric of metrics(), in the same order.
std::span<const MetricValue> metric_values();

/// A metric in one repeat, before it is scaled; none where it is not measured. Throws Error where metric_values() has no such name.
std::optional<double> value_of(const Score& score, const Metric& metric);

}  // namespace actformer::eval
