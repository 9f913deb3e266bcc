#include "reports/tables/metric.hpp"

#include <cmath>

#include "base/error.hpp"

namespace actformer::reports {

const char* name_of(eval::Direction better) {
    switch (better) {
        case eval::Direction::lower:
            return "lower";
        case eval::Direction::higher:
            return "higher";
        default:
            return "nearest to real";
    }
}

Metric scored_metric(const std::string& name) {
    const auto* known = eval::find_metric(name);
    if (!known) {
        std::string all;
        for (const auto& metric : eval::metrics())
            all += (all.empty() ? "" : ", ") + std::string(metric.name);
        throw Error("there is no metric '{}'; there are {}", name, all);
    }
    return {name, std::string(known->heading), known->scale, known->direction};
}

double distance_from_best(eval::Direction better, double value, double real) {
    switch (better) {
        case eval::Direction::lower:
            return value;
        case eval::Direction::higher:
            return -value;
        default:
            return std::abs(value - real);
    }
}

}  // namespace actformer::reports
