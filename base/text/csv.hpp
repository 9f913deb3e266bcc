// Text as a cell of a CSV file.
#pragma once

#include <string>
#include <string_view>

namespace actformer {

/// `text` in quotes where it needs them. What a spreadsheet would take for a formula, as it begins with = + - @ a tab or a carriage
/// return, gets an apostrophe before it.
std::string csv_cell(std::string_view text);

}  // namespace actformer
