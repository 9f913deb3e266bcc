// Labels of motions that do not tell their action themselves.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace actformer::eval {

/// A line a motion: its name, blanks, and its action as a class's name or a number from 1 on, A012 or 12. Empty lines and
/// those that begin with # are skipped. Throws Error naming file and line for an action that is not among `classes`, a line
/// without one, or a name that comes twice.
std::map<std::string, std::uint32_t> read_labels_file(const std::filesystem::path& path,
                                                      const std::vector<std::string>& classes);

}  // namespace actformer::eval
