#include "eval/scoring/scorer.hpp"

#include <algorithm>
#include <map>
#include <random>

#include "base/error.hpp"
#include "base/random/shuffle.hpp"
#include "eval/metrics/diversity.hpp"
#include "eval/metrics/fid_infinity.hpp"
#include "eval/metrics/kid.hpp"
#include "eval/metrics/multimodality.hpp"

namespace actformer::eval {
namespace {

/// Classes of two samples or more without any spread but rounding.
std::vector<std::size_t> identical_classes(const Statistics& statistics) {
    std::vector<std::size_t> out;
    for (std::size_t c = 0; c < statistics.by_class.size(); ++c) {
        const auto& moments = statistics.by_class[c];
        if (!moments) continue;
        double square = 0;
        for (const double m : moments->mean) square += m * m;
        if (moments->variance <= 1e-24 * square) out.push_back(c);
    }
    return out;
}

Observed subset(const Observed& from, const std::vector<std::size_t>& which) {
    Observed out;
    out.source = from.source;
    out.of_groups = from.of_groups;
    out.samples = subset(from.samples, which);
    if (from.groups) out.groups = subset(*from.groups, which);
    if (from.motion) out.motion = subset(*from.motion, which);
    return out;
}

/// Each class's clips with their samples, in the order in which they come.
std::vector<std::vector<std::vector<std::size_t>>> clips_of(const Observed& real) {
    std::vector<std::vector<std::vector<std::size_t>>> out(real.samples.classes);
    std::vector<std::map<std::string, std::size_t>> seen(real.samples.classes);
    for (std::size_t i = 0; i < real.samples.size(); ++i) {
        const auto label = real.samples.labels[i];
        auto at = out[label].size();
        if (!real.clips.empty()) at = seen[label].try_emplace(real.clips[i], at).first->second;
        if (at == out[label].size()) out[label].emplace_back();
        out[label][at].push_back(i);
    }
    return out;
}

}  // namespace

void check_comparable(const Observed& real, const Observed& generated) {
    const auto compare = [&](const Samples& r, const Samples& g) {
        if (r.dimensions != g.dimensions)
            throw Error(
                "{}: its features have {} dimensions and those of {} have {}; take both from one recogniser",
                generated.source, g.dimensions, real.source, r.dimensions);
        if (r.classes != g.classes)
            throw Error("{}: has {} classes and {} has {}; score motions of the same classes",
                        generated.source, g.classes, real.source, r.classes);
    };
    compare(real.samples, generated.samples);
    if (real.groups && generated.groups) compare(*real.groups, *generated.groups);
    for (const auto* side : {&real, &generated})
        if (side->motion && side->motion->size() != side->samples.size())
            throw Error(
                "{}: {} of its motions are measured and {} have features; remove what an interrupted scoring "
                "left "
                "(SCORES.json.work) and score again",
                side->source, side->motion->size(), side->samples.size());
}

double accuracy_of(const Confusion& confusion, const ScorerOptions& options) {
    return options.protocol == Protocol::actor ? confusion.sample_accuracy()
                                               : confusion.mean_class_accuracy();
}

std::optional<double> multimodality_of(const Samples& samples, const ScorerOptions& options) {
    const auto drawn =
        options.protocol == Protocol::actor ? PairsDrawn::with_replacement : PairsDrawn::of_different_samples;
    return multimodality(samples, options.multimodality_pairs, options.seed, drawn);
}

Scorer::Scorer(const Observed& real, const ScorerOptions& options) : options_(options) {
    if (real.samples.size() < 2)
        throw Error("{}: one sample is too few to score against; take a larger split", real.source);
    real_ = statistics_of(real.samples, options.threads);
    if (options.kid || options.fid_infinity) real_samples_ = real.samples;
    if (real.motion) {
        real_motion_ = real.motion;
        real_members_ = members_by_class(real.samples);
    }
    if (real.groups) real_groups_ = statistics_of(*real.groups, options.threads);
}

Score Scorer::score(const Observed& generated) const {
    const auto& samples = generated.samples;
    if (samples.size() < 2)
        throw Error("{}: one sample is too few to score; generate some of every class", generated.source);
    Score out;
    const auto statistics = statistics_of(samples, options_.threads);
    out.counts = statistics.counts;
    if (!samples.logits.empty()) {
        out.confusion = confusion_of(samples);
        out.accuracy = accuracy_of(*out.confusion, options_);
    }
    (generated.of_groups ? out.fid_groups : out.fid) = distances(real_, statistics, options_.threads);
    if (real_groups_ && generated.groups)
        out.fid_groups =
            distances(*real_groups_, statistics_of(*generated.groups, options_.threads), options_.threads);
    if (!generated.of_groups) {
        out.diversity = diversity(samples, options_.diversity_pairs, options_.seed);
        out.multimodality = multimodality_of(samples, options_);
    }
    if (options_.kid) {
        out.kid_mean = kid_mean(*real_samples_, samples, options_.threads);
        out.kid_whole = kid(*real_samples_, samples, options_.threads);
    }
    if (options_.fid_infinity)
        if (const auto found = fid_infinity(*real_samples_, samples, options_.seed, options_.threads)) {
            out.fid_mean_infinity = found->mean;
            out.fid_whole_infinity = found->whole;
        }
    if (real_motion_ && generated.motion) {
        out.motion = compare(*real_motion_, all_indices(real_motion_->size()), *generated.motion,
                             all_indices(generated.motion->size()));
        const auto members = members_by_class(samples);
        for (std::size_t c = 0; c < members.size(); ++c)
            out.motion_by_class.push_back(
                compare(*real_motion_, real_members_[c], *generated.motion, members[c]));
    }
    out.identical = identical_classes(statistics);
    return out;
}

std::optional<Floor> score_floor(const Observed& real, const std::vector<std::size_t>& wanted,
                                 const ScorerOptions& options) {
    std::mt19937_64 random(options.seed);
    std::vector<std::size_t> drawn, rest;
    auto classes = clips_of(real);
    for (std::size_t c = 0; c < classes.size(); ++c) {
        auto& clips = classes[c];
        std::size_t all = 0, taken = 0;
        for (const auto& clip : clips) all += clip.size();
        const auto most = std::min(wanted[c], all / 2);
        shuffle(clips, random);
        for (const auto& clip : clips) {
            const bool fits = taken + clip.size() <= most;
            auto& to = fits ? drawn : rest;
            if (fits) taken += clip.size();
            to.insert(to.end(), clip.begin(), clip.end());
        }
    }
    if (drawn.size() < 2 || rest.size() < 2) return {};
    std::sort(drawn.begin(), drawn.end());
    std::sort(rest.begin(), rest.end());
    const Scorer scorer(subset(real, rest), options);
    return Floor{scorer.score(subset(real, drawn)), scorer.real().counts};
}

}  // namespace actformer::eval
