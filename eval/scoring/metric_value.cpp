#include "eval/scoring/metric_value.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace actformer::eval {
namespace {

std::optional<double> mean_of(const std::optional<Distances>& distances) {
    return distances ? distances->mean : std::nullopt;
}

std::optional<double> whole_of(const std::optional<Distances>& distances) {
    return distances ? std::optional(distances->whole) : std::nullopt;
}

constexpr MetricValue value_table[] = {
    {"accuracy", [](const Score& s) { return s.accuracy; }},
    {"fid_mean", [](const Score& s) { return mean_of(s.fid); }},
    {"fid_whole", [](const Score& s) { return whole_of(s.fid); }},
    {"fida_mean", [](const Score& s) { return mean_of(s.fid_groups); }},
    {"fida_whole", [](const Score& s) { return whole_of(s.fid_groups); }},
    {"fid_mean_infinity", [](const Score& s) { return s.fid_mean_infinity; }},
    {"fid_whole_infinity", [](const Score& s) { return s.fid_whole_infinity; }},
    {"kid_mean", [](const Score& s) { return s.kid_mean; }},
    {"kid_whole", [](const Score& s) { return s.kid_whole; }},
    {"diversity", [](const Score& s) { return s.diversity; }},
    {"multimodality", [](const Score& s) { return s.multimodality; }},
    {"limb_acceleration", nullptr, &MotionScore::limb_acceleration},
    {"root_acceleration", nullptr, &MotionScore::root_acceleration},
    {"root_speed", nullptr, &MotionScore::root_speed},
    {"foot_sliding", nullptr, &MotionScore::foot_sliding},
    {"root_distance", nullptr, &MotionScore::root_distance},
};

}  // namespace

std::span<const MetricValue> metric_values() {
    return value_table;
}

std::optional<double> value_of(const Score& score, const Metric& metric) {
    const auto* found = std::ranges::find(value_table, metric.name, &MetricValue::name);
    if (found == std::end(value_table)) throw Error("metric '{}' has no value", metric.name);
    return found->of_motion ? score.motion.*(found->of_motion) : found->of(score);
}

}  // namespace actformer::eval
