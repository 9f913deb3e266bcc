#include "base/text/nearest_word.hpp"

#include <algorithm>

namespace actformer {

std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
    std::string best;
    std::size_t edits_of_best = 0;  // of words of which one is part of the other, the longer part is nearer
    std::size_t fewest = std::max<std::size_t>(2, word.size() / 2);
    for (const auto& candidate : candidates) {
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
