// Repeats of a generator's scores put together: what `actformer score` says.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "eval/metrics/interval.hpp"
#include "eval/scoring/metric_value.hpp"

namespace actformer::eval {

struct ScoreReport {
    Protocol protocol = Protocol::actformer;
    std::vector<std::string> classes;
    std::vector<Score> repeats;           ///< at least one
    std::optional<Floor> floor;           ///< the real side against itself
    std::vector<std::size_t> real;        ///< (classes) real samples
    std::optional<double> real_accuracy;  ///< of the recogniser on the real side
    std::optional<double> real_diversity, real_multimodality;
    std::optional<MotionScore> real_motion;  ///< of the real side beside itself
    std::vector<std::string> warnings;
};

/// Scores `repeats` sides, which `generated(i)` gives one at a time, against `real`. Throws Error as check_comparable does, and where
/// some of them have logits and others have none.
ScoreReport score_repeats(const Observed& real, std::vector<std::string> classes, std::size_t repeats,
                          const std::function<Observed(std::size_t)>& generated,
                          const ScorerOptions& options);

/// A class with fewer samples than this on a side is warned of.
constexpr std::size_t thin_class = 50;

/// Of the repeats that have it; none where none has.
std::optional<Interval> summary(const ScoreReport& report, const Metric& metric);

/// One object: every metric of metrics() that a repeat has (accuracy 0..1), each
///   {"mean": .., "ci95": half-width or null, "repeats": [..]}      and absent where it is not measured;
/// beside them
///   "floor"      the same metrics of the real side against itself, one number each, and how it was split
///   "real"       {"samples", "accuracy", "diversity", "multimodality"} of the real side; the motions' own metrics, where measured
///   "per_class"  [{"class", "label", "real", "generated", "accuracy", "fid", "fida", "floor", "fida_floor", and, where
///                motions are measured, their own metrics}] means over the repeats, null where
///                there is none
///   "confusion"  (classes, classes) counts over all repeats, rows the class asked for
///   "left_out"   [{"class", "label", "real", "generated"}] classes without a FID, with the fewest samples that a repeat has
///   "protocol"   where it is another than ActFormer's
///   "warnings"   lines
nlohmann::ordered_json to_json(const ScoreReport& report);

}  // namespace actformer::eval
