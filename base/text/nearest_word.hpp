// What a mistyped word was meant to be.
#pragma once

#include <string>
#include <vector>

namespace actformer {

/// The candidate that takes the fewest letters left out, put in, exchanged or swapped to come to (the optimal string alignment
/// distance); one that is part of the word or has the word in it counts as one letter away. Empty where none is near: more than
/// half of the letters, or two of a short word.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace actformer
