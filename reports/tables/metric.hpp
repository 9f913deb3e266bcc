// How a table prints a metric that `actformer score` measures.
#pragma once

#include <string>

#include "eval/metrics/metric.hpp"

namespace actformer::reports {

/// "lower", "higher", "nearest to real"
const char* name_of(eval::Direction better);

struct Metric {
    std::string name;     ///< in the scores' JSON: "fid_mean"
    std::string heading;  ///< "FIDm"
    double scale = 1;     ///< printed = scale * measured: 100 for shares in per cent
    eval::Direction better = eval::Direction::lower;
};

/// As scoring knows it. Throws Error naming the metrics that there are.
Metric scored_metric(const std::string& name);

/// Distance from the best value; the smaller, the better. `real` is the value of real motions, which only nearest_to_real asks for.
double distance_from_best(eval::Direction better, double value, double real);

}  // namespace actformer::reports
