// The metrics of the tables: one list for scoring, reports and help texts.
//
// To add a metric: write its computation in a file of its own here, give it a line in metric.cpp, and in
// eval/scoring/metric_value.cpp one that fetches its value.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace actformer::eval {

/// Which of two values is better.
enum class Direction {
    lower,
    higher,
    nearest_real  ///< the one nearer to the real samples' own value
};

struct Metric {
    std::string_view name;     ///< in JSON, as in "fid_mean"
    std::string_view heading;  ///< for people, as in "FIDm"
    std::string_view unit;     ///< of the value times `scale`: "%", "m", "m/s" or empty
    double scale = 1;          ///< a table shows the value times this
    Direction direction = Direction::lower;
};

/// In the order of the tables.
const std::vector<Metric>& metrics();

/// By name or heading. Null where there is none.
const Metric* find_metric(std::string_view name);

/// "accuracy %", "FIDm"
std::string heading_with_unit(const Metric& metric);

/// "lower is better", as a table says it.
std::string_view describe(Direction direction);

}  // namespace actformer::eval
