#include "eval/metrics/confusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace actformer::eval {

std::uint64_t Confusion::row_sum(std::size_t truth) const {
    const auto row = counts_.begin() + static_cast<std::ptrdiff_t>(truth * classes_);
    return std::accumulate(row, row + static_cast<std::ptrdiff_t>(classes_), std::uint64_t{0});
}

std::uint64_t Confusion::samples() const {
    return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

double Confusion::mean_class_accuracy() const {
    double sum = 0;
    std::size_t present = 0;
    for (std::size_t c = 0; c < classes_; ++c)
        if (const auto all = row_sum(c)) {
            sum += static_cast<double>(at(c, c)) / static_cast<double>(all);
            ++present;
        }
    return present > 0 ? sum / static_cast<double>(present) : 0;
}

double Confusion::sample_accuracy() const {
    std::uint64_t right = 0;
    for (std::size_t c = 0; c < classes_; ++c) right += at(c, c);
    return samples() > 0 ? static_cast<double>(right) / static_cast<double>(samples()) : 0;
}

std::vector<std::size_t> Confusion::seen() const {
    std::vector<std::size_t> out;
    for (std::size_t c = 0; c < classes_; ++c) {
        auto all = row_sum(c);
        for (std::size_t truth = 0; truth < classes_; ++truth) all += at(truth, c);
        if (all > 0) out.push_back(c);
    }
    return out;
}

/// Per cent of `truth` taken for `guess`.
double Confusion::per_cent(std::size_t truth, std::size_t guess) const {
    return 100 * static_cast<double>(at(truth, guess)) / static_cast<double>(row_sum(truth));
}

std::string Confusion::square(const std::vector<std::string>& names, const std::vector<std::size_t>& shown,
                              std::size_t width) const {
    auto out = fmt::format("{:<{}} samples", "truth", width + 4);
    for (const auto c : shown) out += fmt::format(" {:>4}", c + 1);
    out += "  (per cent taken for class ..)\n";
    for (const auto c : shown) {
        out += fmt::format("{:>3} {:<{}} {:>7}", c + 1, names[c], width, row_sum(c));
        for (const auto g : shown) out += at(c, g) == 0 ? "    ." : fmt::format(" {:>4.0f}", per_cent(c, g));
        out += "\n";
    }
    return out;
}

std::string Confusion::list(const std::vector<std::string>& names, const std::vector<std::size_t>& shown,
                            std::size_t width) const {
    constexpr std::size_t mistakes = 3;
    auto out = fmt::format("{:<{}} samples   right  (per cent; what else it is mostly taken for)\n", "truth",
                           width + 4);
    for (const auto c : shown) {
        if (row_sum(c) == 0) continue;
        out += fmt::format("{:>3} {:<{}} {:>7} {:>7.0f}", c + 1, names[c], width, row_sum(c), per_cent(c, c));
        std::vector<std::size_t> others;
        for (const auto g : shown)
            if (g != c && at(c, g) > 0) others.push_back(g);
        std::stable_sort(others.begin(), others.end(),
                         [&](std::size_t a, std::size_t b) { return at(c, a) > at(c, b); });
        if (others.size() > mistakes) others.resize(mistakes);
        for (const auto g : others)
            out += fmt::format("{} {:.0f} {}", g == others.front() ? " " : ",", per_cent(c, g), names[g]);
        out += "\n";
    }
    return out;
}

std::string Confusion::table(const std::vector<std::string>& names) const {
    constexpr std::size_t most_across = 16;  // with a name before them, what a terminal shows
    const auto shown = seen();
    std::size_t width = 5;
    for (const auto c : shown) width = std::max(width, names[c].size());
    return shown.size() <= most_across ? square(names, shown, width) : list(names, shown, width);
}

std::vector<std::vector<std::uint64_t>> Confusion::rows() const {
    std::vector<std::vector<std::uint64_t>> rows(classes_);
    for (std::size_t c = 0; c < classes_; ++c)
        for (std::size_t g = 0; g < classes_; ++g) rows[c].push_back(at(c, g));
    return rows;
}

std::string near_chance(double accuracy, std::size_t classes) {
    if (classes < 2) return {};
    const double chance = 1 / static_cast<double>(classes);
    if (accuracy >= chance + 0.1 * (1 - chance)) return {};
    return fmt::format(
        "the recogniser is right on {:.1f} % of the real motions, where guessing among {} classes is right "
        "on {:.1f} %: what it says of generated ones means nothing; train it longer, or on this data",
        100 * accuracy, classes, 100 * chance);
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

}  // namespace actformer::eval
