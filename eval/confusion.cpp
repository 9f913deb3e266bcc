#include "eval/confusion.hpp"

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

std::string Confusion::table(const std::vector<std::string>& names) const {
    std::size_t width = 5;
    for (const auto& name : names) width = std::max(width, name.size());
    std::string out = fmt::format("{:<{}} samples", "truth", width + 4);
    for (std::size_t c = 0; c < classes_; ++c) out += fmt::format(" {:>4}", c);
    out += "  (per cent taken for class ..)\n";
    for (std::size_t c = 0; c < classes_; ++c) {
        const auto all = row_sum(c);
        out += fmt::format("{:>3} {:<{}} {:>7}", c, names[c], width, all);
        for (std::size_t g = 0; g < classes_; ++g)
            out += at(c, g) == 0 ? "    ."
                                 : fmt::format(" {:>4.0f}", 100.0 * static_cast<double>(at(c, g)) /
                                                                static_cast<double>(all));
        out += "\n";
    }
    return out;
}

std::vector<std::vector<std::uint64_t>> Confusion::rows() const {
    std::vector<std::vector<std::uint64_t>> rows(classes_);
    for (std::size_t c = 0; c < classes_; ++c)
        for (std::size_t g = 0; g < classes_; ++g) rows[c].push_back(at(c, g));
    return rows;
}

}  // namespace actformer::eval
