#include "base/text/suggestion.hpp"

#include "base/text/nearest_word.hpp"
#include "base/text/printable.hpp"

namespace actformer {

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
    const auto nearest = nearest_word(word, candidates);
    return nearest.empty() ? "" : "; did you mean " + printable(nearest) + "?";
}

}  // namespace actformer
