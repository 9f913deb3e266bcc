// What a shell needs to complete the words of a command line.
#pragma once

#include "cli/command_tree.hpp"

namespace actformer::cli {

/// Shells that completion() knows.
std::vector<std::string> shells();

/// The script for one of shells(): commands, options, values of options that take only some, and files elsewhere.
std::string completion(const CommandHelp& root, const std::string& shell);

}  // namespace actformer::cli
