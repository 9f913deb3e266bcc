#include "reports/tables/metric.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/text/suggestion.hpp"

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

const eval::Metric& scored_metric(std::string_view name) {
    const auto* known = eval::find_metric(name);
    if (!known) {
        std::vector<std::string> all;
        for (const auto& metric : eval::metrics()) all.emplace_back(metric.name);
        throw Error("there is no metric '{}'{}; there are {}", name, suggestion(std::string(name), all),
                    fmt::join(all, ", "));
    }
    return *known;
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
