#include "reports/tables/metric.hpp"

#include <cmath>

#include "base/error.hpp"
#include "eval/scoring/score_report.hpp"

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

Metric scored_metric(const std::string& name) {
    const auto* known = eval::find_metric(name);
    if (!known) {
        std::string all;
        for (const auto& metric : eval::metrics)
            all += (all.empty() ? "" : ", ") + std::string(metric.name);
        throw Error("there is no metric '{}'; there are {}", name, all);
    }
    const bool share = name == "accuracy", spread = name == "diversity" || name == "multimodality";
    return {name, known->heading, share ? 100.0 : 1.0,
            spread                     ? Better::nearest_to_real
            : known->smaller_is_better ? Better::lower
                                       : Better::higher};
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
