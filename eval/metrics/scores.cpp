#include "eval/metrics/scores.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.hpp"
#include "base/threads/parallel.hpp"

namespace actformer::eval {
namespace {

using Index = std::vector<std::size_t>;

/// Which samples each class has.
std::vector<Index> by_label(const Samples& samples) {
    std::vector<Index> out(samples.classes);
    for (std::size_t i = 0; i < samples.size(); ++i) out[samples.labels[i]].push_back(i);
    return out;
}

std::span<const double> row(const Samples& samples, std::size_t i) {
    return std::span(samples.features).subspan(i * samples.dimensions, samples.dimensions);
}

std::vector<double> rows(const Samples& samples, const Index& which) {
    std::vector<double> out;
    out.reserve(which.size() * samples.dimensions);
    for (const auto i : which) {
        const auto from = row(samples, i);
        out.insert(out.end(), from.begin(), from.end());
    }
    return out;
}

double distance(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
}

using Random = std::mt19937_64;

/// Below `n`, every number as likely to 2^-32 n.
std::size_t draw(Random& random, std::size_t n) {
    return static_cast<std::size_t>(((random() >> 32) * n) >> 32);
}

/// Of random pairs among `which`, two samples or more.
double mean_distance(const Samples& samples, const Index& which, std::size_t pairs, Random& random) {
    double sum = 0;
    for (std::size_t i = 0; i < pairs; ++i) {
        const auto one = draw(random, which.size());
        auto other = draw(random, which.size() - 1);
        if (other >= one) ++other;
        sum += distance(row(samples, which[one]), row(samples, which[other]));
    }
    return sum / static_cast<double>(pairs);
}

template <typename T>
void check_finite(const std::vector<T>& values, std::size_t columns, const char* what,
                  const std::string& where) {
    const auto bad = std::find_if(values.begin(), values.end(), [](T v) { return !std::isfinite(v); });
    if (bad == values.end()) return;
    const auto at = static_cast<std::size_t>(bad - values.begin());
    throw Error("{}: {} {} of sample {} is not finite; leave that sample out, or make it again", where, what,
                at % columns, at / columns);
}

}  // namespace

void check(const Samples& samples, const std::string& where) {
    const auto n = samples.size();
    if (n == 0) throw Error("{}: holds no samples", where);
    if (samples.dimensions == 0 || samples.features.size() != n * samples.dimensions)
        throw Error("{}: {} labels do not go with {} features of {} dimensions", where, n,
                    samples.features.size(), samples.dimensions);
    if (!samples.logits.empty() && samples.logits.size() != n * samples.classes)
        throw Error("{}: {} samples do not go with {} logits of {} classes", where, n, samples.logits.size(),
                    samples.classes);
    for (std::size_t i = 0; i < n; ++i)
        if (samples.labels[i] >= samples.classes)
            throw Error("{}: sample {} has label {}, and labels go from 0 to {}", where, i, samples.labels[i],
                        samples.classes - 1);
    check_finite(samples.features, samples.dimensions, "feature", where);
    check_finite(samples.logits, samples.classes, "logit", where);
}

Confusion confusion_of(const Samples& samples) {
    Confusion confusion(samples.classes);
    const auto classes = static_cast<std::ptrdiff_t>(samples.classes);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto first = samples.logits.begin() + static_cast<std::ptrdiff_t>(i) * classes;
        confusion.add(samples.labels[i],
                      static_cast<std::size_t>(std::max_element(first, first + classes) - first));
    }
    return confusion;
}

std::vector<std::optional<Moments>> moments_by_class(const Samples& samples, unsigned threads) {
    const auto members = by_label(samples);
    std::vector<std::optional<Moments>> out(members.size());
    parallel_for(members.size(), thread_count(threads), [&](std::size_t c, unsigned) {
        if (members[c].size() >= 2) out[c] = fit(rows(samples, members[c]), samples.dimensions);
    });
    return out;
}

Statistics statistics_of(const Samples& samples, unsigned threads) {
    Statistics out;
    out.samples = samples.size();
    out.whole = fit(samples.features, samples.dimensions, threads);
    out.by_class = moments_by_class(samples, threads);
    for (const auto& members : by_label(samples)) out.counts.push_back(members.size());
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

std::optional<double> diversity(const Samples& samples, std::size_t pairs, std::uint64_t seed) {
    if (samples.size() < 2 || pairs == 0) return {};
    Index all(samples.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    Random random(seed);
    return mean_distance(samples, all, pairs, random);
}

std::optional<double> multimodality(const Samples& samples, std::size_t pairs, std::uint64_t seed) {
    Random random(seed);
    double sum = 0;
    std::size_t measured = 0;
    for (const auto& members : by_label(samples)) {
        if (members.size() < 2 || pairs == 0) continue;
        sum += mean_distance(samples, members, pairs, random);
        ++measured;
    }
    if (measured == 0) return {};
    return sum / static_cast<double>(measured);
}

}  // namespace actformer::eval
