#include "eval/scoring/classify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "eval/scoring/windows_source.hpp"

namespace actformer::eval {
namespace {

/// The sum of a clip's logits over its windows.
struct Sum {
    std::string clip;
    std::uint32_t windows = 0;
    std::vector<double> logits;
};

/// Index of the largest, `but` apart; the first of equal ones.
std::uint32_t largest(const std::vector<double>& values, std::size_t but) {
    std::size_t best = but == 0 ? 1 : 0;
    for (std::size_t c = best + 1; c < values.size(); ++c)
        if (c != but && values[c] > values[best]) best = c;
    return static_cast<std::uint32_t>(best);
}

Classified classified(const Sum& sum) {
    auto logits = sum.logits;
    for (auto& v : logits) v /= sum.windows;
    const auto best = largest(logits, logits.size());
    double total = 0;
    for (const double v : logits) total += std::exp(v - logits[best]);
    const auto guess = [&](std::uint32_t c) { return Guess{c, std::exp(logits[c] - logits[best]) / total}; };
    Classified out{sum.clip, sum.windows, guess(best), {}};
    if (logits.size() > 1) out.runner_up = guess(largest(logits, best));
    return out;
}

}  // namespace

std::vector<Classified> classify(MotionSource& motions, FeatureExtractor& extractor, const OnProgress& tell) {
    const auto& info = motions.info();
    extractor.check_fits(info);
    extractor.begin_set(info);
    const auto classes = extractor.classes();
    std::vector<Sum> sums;
    std::vector<std::size_t> clip_at;  // of each row
    std::map<std::string, std::size_t> known;
    for (const auto& name : info.names) {
        const auto [at, fresh] = known.try_emplace(info.are_windows ? clip_of(name) : name, sums.size());
        if (fresh) sums.push_back({at->first, 0, std::vector<double>(classes, 0)});
        clip_at.push_back(at->second);
    }
    std::uint64_t done = 0;
    for (auto batch = motions.next(); !batch.rows.empty(); batch = motions.next()) {
        const auto got = extractor.extract(batch, info);
        for (std::size_t i = 0; i < batch.rows.size(); ++i) {
            auto& sum = sums[clip_at[batch.rows[i]]];
            ++sum.windows;
            for (std::size_t c = 0; c < classes; ++c) sum.logits[c] += got.logits[i * classes + c];
        }
        done += batch.rows.size();
        if (tell) tell(done, info.names.size());
    }
    std::vector<Classified> out;
    for (const auto& sum : sums) out.push_back(classified(sum));
    return out;
}

std::vector<std::string> class_names(const RecogniserInfo& recogniser, const MotionsInfo& motions) {
    if (recogniser.class_names.size() == recogniser.classes) return recogniser.class_names;
    if (motions.classes.size() == recogniser.classes) return motions.classes;
    std::vector<std::string> names;
    for (std::uint32_t c = 0; c < recogniser.classes; ++c) names.push_back(fmt::format("A{:03}", c + 1));
    return names;
}

}  // namespace actformer::eval
