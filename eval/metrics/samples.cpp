#include "eval/metrics/samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"

namespace actformer::eval {
namespace {

template <typename T>
void check_finite(const std::vector<T>& values, std::size_t columns, const char* what,
                  const std::string& where) {
    constexpr double most = 1e150;  // squares of larger ones, added up, are infinite
    const auto bad =
        std::find_if(values.begin(), values.end(), [](T v) { return !(std::abs(double{v}) < most); });
    if (bad == values.end()) return;
    const auto at = static_cast<std::size_t>(bad - values.begin());
    throw Error(
        "{}: {} {} of sample {} is not finite or beyond 1e150; leave that sample out, or make it again",
        where, what, at % columns, at / columns);
}

}  // namespace

std::span<const double> features_of(const Samples& samples, std::size_t i) {
    return std::span(samples.features).subspan(i * samples.dimensions, samples.dimensions);
}

std::vector<std::vector<std::size_t>> members_by_class(const Samples& samples) {
    std::vector<std::vector<std::size_t>> out(samples.classes);
    for (std::size_t i = 0; i < samples.size(); ++i) out[samples.labels[i]].push_back(i);
    return out;
}

std::vector<std::size_t> all_indices(std::size_t n) {
    std::vector<std::size_t> all(n);
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
}

Samples subset(const Samples& from, const std::vector<std::size_t>& which) {
    Samples out;
    out.dimensions = from.dimensions;
    out.classes = from.classes;
    out.features.reserve(which.size() * from.dimensions);
    const auto append = [](auto& to, const auto& values, std::size_t row, std::size_t columns) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * columns);
        to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(columns));
    };
    for (const auto i : which) {
        append(out.features, from.features, i, from.dimensions);
        if (!from.logits.empty()) append(out.logits, from.logits, i, from.classes);
        out.labels.push_back(from.labels[i]);
    }
    return out;
}

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

}  // namespace actformer::eval
