// BABEL's categories of action that become classes.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::ingest {

/// The 120 most frequent, in the order of their frequency: BABEL-120. The first 60 are BABEL-60.
std::span<const std::string_view> babel_categories();

/// "120", "60" or another number: the most frequent; names with commas between; or a file of names, a line each. Any name is taken, and capitals count: BABEL has more
/// categories than these. Throws Error, naming the file or the option, where there is no name or one comes twice.
std::vector<std::string> categories_called(const std::string& said);

}  // namespace actformer::ingest
