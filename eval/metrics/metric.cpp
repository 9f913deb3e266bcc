#include "eval/metrics/metric.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace actformer::eval {

const std::vector<Metric>& metrics() {
    static const std::vector<Metric> list{
        {"accuracy", "accuracy", "%", 100, Direction::higher},
        {"fid_mean", "FIDm", "", 1, Direction::lower},
        {"fid_whole", "FIDw", "", 1, Direction::lower},
        {"fida_mean", "FIDa_m", "", 1, Direction::lower},
        {"fida_whole", "FIDa_w", "", 1, Direction::lower},
        {"fid_mean_infinity", "FIDm at infinity", "", 1, Direction::lower},
        {"fid_whole_infinity", "FIDw at infinity", "", 1, Direction::lower},
        {"kid_mean", "KIDm", "", 1, Direction::lower},
        {"kid_whole", "KIDw", "", 1, Direction::lower},
        {"diversity", "diversity", "", 1, Direction::nearest_real},
        {"multimodality", "multimodality", "", 1, Direction::nearest_real},
        {"limb_acceleration", "limb acceleration", "", 1, Direction::nearest_real},
        {"root_acceleration", "root acceleration", "", 1, Direction::nearest_real},
        {"root_speed", "root speed", "", 1, Direction::nearest_real},
        {"foot_sliding", "foot sliding", "m/s", 1, Direction::nearest_real},
        {"root_distance", "root distance", "m", 1, Direction::lower},
    };
    return list;
}

const Metric* find_metric(std::string_view name) {
    const auto found = std::ranges::find_if(
        metrics(), [&](const Metric& metric) { return name == metric.name || name == metric.heading; });
    return found == metrics().end() ? nullptr : &*found;
}

std::string heading_with_unit(const Metric& metric) {
    return metric.unit.empty() ? std::string(metric.heading)
                               : fmt::format("{} {}", metric.heading, metric.unit);
}

std::string_view describe(Direction direction) {
    switch (direction) {
        case Direction::lower:
            return "lower is better";
        case Direction::higher:
            return "higher is better";
        default:
            return "nearest to real is better";
    }
}

}  // namespace actformer::eval
