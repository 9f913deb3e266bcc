// Options that take a file of the user's, or one that comes with the program by its name.
#pragma once

#include <fmt/format.h>

#include "base/process/shipped.hpp"
#include "cli/commands.hpp"

namespace actformer::cli {

/// The option's value becomes the path of the file, or of what comes with the program in `folder`, as in "model/configs".
inline CLI::Option* takes_shipped(CLI::Option* option, const std::string& folder) {
    return option->transform(
        [folder](const std::string& named) { return file_or_shipped(named, folder).string(); });
}

/// The command without a word behind it prints what comes with the program in `folder`: names, and how each begins.
void lists_shipped(CLI::App* command, const std::string& folder);

}  // namespace actformer::cli
