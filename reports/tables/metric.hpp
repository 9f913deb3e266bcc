// What tables ask of a metric that `actformer score` measures.
#pragma once

#include <string_view>

#include "eval/metrics/metric.hpp"

namespace actformer::reports {

/// "lower", "higher", "nearest to real"
const char* name_of(eval::Direction better);

/// As scoring knows it. Throws Error naming the metrics that there are.
const eval::Metric& scored_metric(std::string_view name);

/// Distance from the best value; the smaller, the better. `real` is the value of real motions, which only nearest_to_real asks for.
double distance_from_best(eval::Direction better, double value, double real);

}  // namespace actformer::reports
