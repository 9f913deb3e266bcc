// Man pages, of the text that --help prints.
#pragma once

#include <filesystem>

#include "cli/command_tree.hpp"

namespace actformer::cli {

/// A page of every command in `folder`, called as in actformer-ingest-ntu.1. The number of pages. Throws Error where one cannot be
/// written.
std::size_t write_man_pages(const CommandHelp& root, const std::filesystem::path& folder);

}  // namespace actformer::cli
