// What a mistyped word was meant to be.
#pragma once

#include <string>
#include <vector>

namespace actformer {

/// Letters left out, put in, exchanged or swapped to come from one to the other (the optimal string alignment distance).
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The candidate that takes the fewest of them to come to; one that is part of the word or has the word in it counts as one letter away.
/// Empty where none is near: more than half of the letters, or two of a short word. Words of more than 255 letters are near to none.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace actformer
