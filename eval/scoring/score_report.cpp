#include "eval/scoring/score_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/first_few.hpp"
#include "eval/metrics/diversity.hpp"
#include "eval/metrics/fid_infinity.hpp"

namespace actformer::eval {
namespace {

using Json = nlohmann::ordered_json;

template <typename T>
Json number(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

std::string listed(const std::vector<std::string>& items) {
    return few_and_more(items, 8);
}

/// Fewest samples that any repeat has of a class.
std::size_t fewest(const ScoreReport& report, std::size_t label) {
    std::size_t least = report.repeats[0].counts[label];
    for (const auto& score : report.repeats) least = std::min(least, score.counts[label]);
    return least;
}

std::vector<std::size_t> left_out(const ScoreReport& report) {
    std::vector<std::size_t> out;
    for (std::size_t c = 0; c < report.classes.size(); ++c)
        if (report.real[c] < 2 || fewest(report, c) < 2) out.push_back(c);
    return out;
}

void warn_of_counts(ScoreReport& report) {
    std::vector<std::string> missing, thin;
    std::size_t absent = 0;
    for (std::size_t c = 0; c < report.classes.size(); ++c) {
        const auto real = report.real[c], made = fewest(report, c);
        const auto line = fmt::format("{} ({} real, {} generated)", report.classes[c], real, made);
        if (real == 0 && made == 0)
            ++absent;
        else if (real < 2 || made < 2)
            missing.push_back(line);
        else if (std::min(real, made) < thin_class)
            thin.push_back(line);
    }
    if (absent > 0)
        report.warnings.push_back(
            fmt::format("{} of {} classes have no sample on either side", absent, report.classes.size()));
    if (!missing.empty())
        report.warnings.push_back(fmt::format(
            "left out of the per-class FID, having fewer than 2 samples on a side: {} of {} classes: {}",
            missing.size(), report.classes.size(), listed(missing)));
    if (!thin.empty())
        report.warnings.push_back(fmt::format(
            "fewer than {} samples on a side make a class's FID mostly chance: {} of {} classes: {}",
            thin_class, thin.size(), report.classes.size(), listed(thin)));
}

void warn_of_collapse(ScoreReport& report) {
    std::vector<std::string> same;
    for (std::size_t c = 0; c < report.classes.size(); ++c)
        for (const auto& score : report.repeats)
            if (std::count(score.identical.begin(), score.identical.end(), c) > 0) {
                same.push_back(fmt::format("{} ({} samples)", report.classes[c], score.counts[c]));
                break;
            }
    if (!same.empty())
        report.warnings.push_back(
            fmt::format("all generated samples of a class are the same: {}", listed(same)));
}

void warn_of_floor(ScoreReport& report) {
    if (!report.floor) {
        report.warnings.emplace_back("the real side is too small to be scored against itself: no floor");
        return;
    }
    const auto& metric = *find_metric(report.repeats[0].fid ? "fid_mean" : "fida_mean");
    const auto at_best = value_of(report.floor->score, metric);
    const auto got = summary(report, metric);
    if (got && at_best && *at_best > got->mean / 2)
        report.warnings.push_back(
            fmt::format("real samples against real ones come to an {} of {:.4g}: of {:.4g} much is "
                        "owed to few samples",
                        metric.heading, *at_best, got->mean));
}

/// As in "no FIDw at infinity"; empty where every repeat has the metric.
std::string lacking(const ScoreReport& report, std::string_view name) {
    const auto& metric = *find_metric(name);
    const auto all = report.repeats.size();
    const auto without = static_cast<std::size_t>(
        std::ranges::count_if(report.repeats, [&](const Score& s) { return !value_of(s, metric); }));
    if (without == 0) return {};
    return fmt::format("no {}{}", metric.heading,
                       without == all ? "" : fmt::format(" in {} of {} repeats", without, all));
}

void warn_of_fid_infinity(ScoreReport& report) {
    std::vector<std::size_t> made;
    for (std::size_t c = 0; c < report.classes.size(); ++c) made.push_back(fewest(report, c));
    const auto on_both = [&](std::size_t c) { return std::min(report.real[c], made[c]); };
    const auto most = std::ranges::max(all_indices(made.size()), {}, on_both);
    if (const auto no = lacking(report, "fid_mean_infinity"); !no.empty())
        report.warnings.push_back(
            fmt::format("{}: it needs {} samples of a class on each side; {} comes nearest, with {} real and "
                        "{} generated",
                        no, least_of_class, report.classes[most], report.real[most], made[most]));
    if (const auto no = lacking(report, "fid_whole_infinity"); !no.empty())
        report.warnings.push_back(fmt::format(
            "{}: it needs 2 samples on each side in a quarter of every class, rounded down, as {} "
            "of one class give; there are {} real and {} generated",
            no, least_of_class, in_smallest_subset(report.real), in_smallest_subset(made)));
}

std::optional<double> class_accuracy(const Score& score, std::size_t label) {
    if (!score.confusion || score.counts[label] == 0) return {};
    return static_cast<double>(score.confusion->at(label, label)) / static_cast<double>(score.counts[label]);
}

/// Mean over the repeats that have a value.
template <typename Of>
std::optional<double> mean_of(const ScoreReport& report, Of of) {
    std::vector<double> values;
    for (const auto& score : report.repeats)
        if (const std::optional<double> value = of(score)) values.push_back(*value);
    if (values.empty()) return {};
    return interval(values).mean;
}

/// Whether its motions could be measured.
bool is_measured(const Score& score) {
    return !score.motion_by_class.empty();
}

std::size_t measured_repeats(const ScoreReport& report) {
    return static_cast<std::size_t>(std::ranges::count_if(report.repeats, is_measured));
}

void warn_of_unmeasured(ScoreReport& report) {
    const auto measured = measured_repeats(report), all = report.repeats.size();
    if (measured > 0 && measured < all)
        report.warnings.push_back(
            fmt::format("accelerations, speeds and sliding are those of {} of {} repeats: the motions of the "
                        "others do not tell their "
                        "representation",
                        measured, all));
}

Json class_json(const ScoreReport& report, std::size_t c) {
    const auto of_class = [c](const std::optional<Distances>& d) {
        return d ? d->by_class[c] : std::optional<double>();
    };
    const auto fid = [&](const Score& s) { return of_class(s.fid); };
    const auto fida = [&](const Score& s) { return of_class(s.fid_groups); };
    Json out{{"class", report.classes[c]},
             {"label", c},
             {"real", report.real[c]},
             {"generated", fewest(report, c)},
             {"accuracy", number(mean_of(report, [c](const Score& s) { return class_accuracy(s, c); }))},
             {"fid", number(mean_of(report, fid))},
             {"fida", number(mean_of(report, fida))},
             {"floor", report.floor ? number(fid(report.floor->score)) : Json(nullptr)},
             {"fida_floor", report.floor ? number(fida(report.floor->score)) : Json(nullptr)}};
    if (measured_repeats(report) == 0) return out;
    for (const auto& value : metric_values())
        if (value.of_motion)
            out[std::string(value.name)] = number(mean_of(report, [&](const Score& s) {
                return is_measured(s) ? s.motion_by_class[c].*(value.of_motion) : std::optional<double>();
            }));
    return out;
}

/// What real motions measure, and no distances: of the real side to itself they are 0.
void add_real_motion(const MotionScore& motion, Json& real) {
    for (const auto& value : metric_values())
        if (value.of_motion && find_metric(value.name)->direction != Direction::lower &&
            motion.*(value.of_motion))
            real[std::string(value.name)] = *(motion.*(value.of_motion));
}

Json floor_json(const Floor& floor) {
    Json out;
    for (const auto& metric : metrics())
        if (const auto value = value_of(floor.score, metric)) out[std::string(metric.name)] = *value;
    std::size_t drawn = 0, rest = 0;
    for (const auto n : floor.score.counts) drawn += n;
    for (const auto n : floor.rest) rest += n;
    out["samples"] = drawn;
    out["against"] = rest;
    out["how"] =
        "whole clips drawn from every class of the real side, as many samples as generated ones or half of "
        "the "
        "class, against the rest";
    return out;
}

Json confusion_json(const ScoreReport& report) {
    const auto n = report.classes.size();
    std::vector<std::vector<std::uint64_t>> rows(n, std::vector<std::uint64_t>(n, 0));
    for (const auto& score : report.repeats)
        for (std::size_t t = 0; t < n; ++t)
            for (std::size_t g = 0; g < n; ++g) rows[t][g] += score.confusion->at(t, g);
    return rows;
}

}  // namespace

ScoreReport score_repeats(const Observed& real, std::vector<std::string> classes, std::size_t repeats,
                          const std::function<Observed(std::size_t)>& generated,
                          const ScorerOptions& options) {
    ScoreReport report;
    report.protocol = options.protocol;
    report.classes = std::move(classes);
    const Scorer scorer(real, options);
    bool has_logits = false;
    std::string first;
    for (std::size_t i = 0; i < repeats; ++i) {
        const auto side = generated(i);
        check_comparable(real, side);
        if (i == 0) {
            has_logits = !side.samples.logits.empty();
            first = side.source;
        } else if (side.samples.logits.empty() == has_logits) {
            throw Error("{} has logits and {} has none; score repeats that all have them, or none",
                        has_logits ? first : side.source, has_logits ? side.source : first);
        }
        report.repeats.push_back(scorer.score(side));
    }
    report.real = scorer.real().counts;
    report.floor = score_floor(real, report.repeats[0].counts, options);
    if (!real.samples.logits.empty()) report.real_accuracy = accuracy_of(confusion_of(real.samples), options);
    if (!real.of_groups) {
        report.real_diversity = diversity(real.samples, options.diversity_pairs, options.seed);
        report.real_multimodality = multimodality_of(real.samples, options);
    }
    if (real.motion) {
        const auto all = all_indices(real.motion->size());
        report.real_motion = compare(*real.motion, all, *real.motion, all);
    }
    warn_of_counts(report);
    warn_of_collapse(report);
    warn_of_floor(report);
    warn_of_unmeasured(report);
    if (options.fid_infinity) warn_of_fid_infinity(report);
    if (report.real_accuracy)
        if (auto warning = near_chance(*report.real_accuracy, report.classes.size()); !warning.empty())
            report.warnings.push_back(std::move(warning));
    return report;
}

std::optional<Interval> summary(const ScoreReport& report, const Metric& metric) {
    std::vector<double> values;
    for (const auto& score : report.repeats)
        if (const auto value = value_of(score, metric)) values.push_back(*value);
    if (values.empty()) return {};
    return report.protocol == Protocol::actor ? normal_interval(values) : interval(values);
}

nlohmann::ordered_json to_json(const ScoreReport& report) {
    Json out;
    for (const auto& metric : metrics()) {
        const auto got = summary(report, metric);
        if (!got) continue;
        Json each = Json::array();
        for (const auto& score : report.repeats) each.push_back(number(value_of(score, metric)));
        out[std::string(metric.name)] = {
            {"mean", got->mean}, {"ci95", number(got->half_width)}, {"repeats", each}};
    }
    if (report.floor) out["floor"] = floor_json(*report.floor);
    std::size_t samples = 0;
    for (const auto n : report.real) samples += n;
    out["real"] = {{"samples", samples},
                   {"accuracy", number(report.real_accuracy)},
                   {"diversity", number(report.real_diversity)},
                   {"multimodality", number(report.real_multimodality)}};
    if (report.real_motion) add_real_motion(*report.real_motion, out["real"]);
    out["per_class"] = Json::array();
    for (std::size_t c = 0; c < report.classes.size(); ++c) out["per_class"].push_back(class_json(report, c));
    if (report.repeats[0].confusion) out["confusion"] = confusion_json(report);
    out["left_out"] = Json::array();
    for (const auto c : left_out(report))
        out["left_out"].push_back({{"class", report.classes[c]},
                                   {"label", c},
                                   {"real", report.real[c]},
                                   {"generated", fewest(report, c)}});
    if (report.protocol == Protocol::actor) out["protocol"] = "actor";
    out["warnings"] = report.warnings;
    return out;
}

}  // namespace actformer::eval
