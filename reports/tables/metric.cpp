#include "reports/tables/metric.hpp"

#include <cmath>

#include "base/error.hpp"
#include "eval/metrics/metric.hpp"

namespace actformer::reports {

const char* name_of(Better better) {
    switch (better) {
        case Better::lower:
            return "lower";
        case Better::higher:
            return "higher";
        default:
            return "nearest to real";
    }
}

namespace {

Better better_of(eval::Direction direction) {
    switch (direction) {
        case eval::Direction::lower:
            return Better::lower;
        case eval::Direction::higher:
            return Better::higher;
        default:
            return Better::nearest_to_real;
    }
}

}  // namespace

Metric scored_metric(const std::string& name) {
    const auto* known = eval::find_metric(name);
    if (!known) {
        std::string all;
        for (const auto& metric : eval::metrics())
            all += (all.empty() ? "" : ", ") + std::string(metric.name);
        throw Error("there is no metric '{}'; there are {}", name, all);
    }
    return {name, std::string(known->heading), known->scale, better_of(known->direction)};
}

double distance_from_best(Better better, double value, double real) {
    switch (better) {
        case Better::lower:
            return value;
        case Better::higher:
            return -value;
        default:
            return std::abs(value - real);
    }
}

}  // namespace actformer::reports
