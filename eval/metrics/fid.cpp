#include "eval/metrics/fid.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/threads/parallel.hpp"

namespace actformer::eval {

std::vector<std::optional<Moments>> moments_by_class(const Samples& samples, unsigned threads) {
    const auto members = members_by_class(samples);
    std::vector<std::optional<Moments>> out(members.size());
    parallel_for(members.size(), thread_count(threads), [&](std::size_t c, unsigned) {
        if (members[c].size() >= 2) out[c] = fit(subset(samples, members[c]).features, samples.dimensions);
    });
    return out;
}

Statistics statistics_of(const Samples& samples, unsigned threads) {
    Statistics out;
    out.samples = samples.size();
    out.whole = fit(samples.features, samples.dimensions, threads);
    out.by_class = moments_by_class(samples, threads);
    for (const auto& members : members_by_class(samples)) out.counts.push_back(members.size());
    return out;
}

std::vector<std::optional<double>> distances_by_class(const std::vector<std::optional<Moments>>& real,
                                                      const std::vector<std::optional<Moments>>& generated,
                                                      unsigned threads) {
    if (real.size() != generated.size())
        throw Error("{} real and {} generated classes cannot be compared", real.size(), generated.size());
    std::vector<std::optional<double>> out(real.size());
    parallel_for(real.size(), thread_count(threads), [&](std::size_t c, unsigned) {
        if (real[c] && generated[c]) out[c] = frechet_distance(*real[c], *generated[c]);
    });
    return out;
}

Distances distances(const Statistics& real, const Statistics& generated, unsigned threads) {
    Distances out;
    out.by_class = distances_by_class(real.by_class, generated.by_class, threads);
    out.whole = frechet_distance(real.whole, generated.whole);
    double sum = 0;
    std::size_t measured = 0;
    for (std::size_t c = 0; c < out.by_class.size(); ++c)
        if (out.by_class[c]) {
            sum += *out.by_class[c];
            ++measured;
        } else {
            out.left_out.push_back({c, real.counts[c], generated.counts[c]});
        }
    if (measured > 0) out.mean = sum / static_cast<double>(measured);
    return out;
}

std::vector<float> largest_of_group(std::span<const float> features, std::size_t dimensions,
                                    std::size_t persons) {
    const auto groups = features.size() / (dimensions * persons);
    std::vector<float> out(groups * dimensions);
    for (std::size_t g = 0; g < groups; ++g)
        for (std::size_t c = 0; c < dimensions; ++c) {
            float largest = features[g * persons * dimensions + c];
            for (std::size_t p = 1; p < persons; ++p)
                largest = std::max(largest, features[(g * persons + p) * dimensions + c]);
            out[g * dimensions + c] = largest;
        }
    return out;
}

}  // namespace actformer::eval
