// A mistyped word's end of a message.
#pragma once

#include <string>
#include <vector>

namespace actformer {

/// "; did you mean WORD?" for the candidate that nearest_word finds, made fit for a message; empty where it finds none.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace actformer
