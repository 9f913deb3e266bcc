// Files of one name, number or path a line.
#pragma once

#include <string_view>
#include <vector>

namespace actformer {

/// The lines of a text without the blanks around them, empty ones left out; a byte order mark is passed over.
std::vector<std::string_view> trimmed_lines(std::string_view text);

}  // namespace actformer
