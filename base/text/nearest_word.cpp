#include "base/text/nearest_word.hpp"

#include <algorithm>
#include <numeric>

namespace actformer {
namespace {

/// Letters of the longest word that is compared: no name of a file is longer, and nobody mistypes one that is.
constexpr std::size_t longest_word = 255;

}  // namespace

std::size_t edit_distance(const std::string& a, const std::string& b) {
    const auto width = b.size() + 1;
    std::vector<std::size_t> two_before(width), before(width), row(width);
    std::iota(before.begin(), before.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j < width; ++j) {
            row[j] = std::min({before[j] + 1, row[j - 1] + 1, before[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], two_before[j - 2] + 1);
        }
        two_before.swap(before);
        before.swap(row);
    }
    return before.back();
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
    std::string best;
    if (word.size() > longest_word) return best;
    std::size_t edits_of_best = 0;  // of words of which one is part of the other, the longer part is nearer
    std::size_t fewest = std::max<std::size_t>(2, word.size() / 2);
    for (const auto& candidate : candidates) {
        if (candidate.size() > longest_word) continue;
        const bool part = word.size() > 2 && (candidate.find(word) != std::string::npos ||
                                              word.find(candidate) != std::string::npos);
        const auto edits = edit_distance(word, candidate), distance = part ? std::size_t{1} : edits;
        if (distance >= std::max(word.size(), candidate.size())) continue;  // not a letter in its place
        if (distance < fewest || (distance == fewest && (best.empty() || edits < edits_of_best))) {
            best = candidate;
            edits_of_best = edits;
            fewest = distance;
        }
    }
    return best;
}

}  // namespace actformer
