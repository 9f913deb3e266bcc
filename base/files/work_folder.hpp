// Folders in which a command works beside its output, and which it removes at the end: whatever else lies at their name stays.
#pragma once

#include <filesystem>
#include <functional>

namespace actformer {

/// Whether the program writes a file of this path, below the folder that it works in.
using IsOwnFile = std::function<bool(const std::filesystem::path& below)>;

/// Throws Error, with the remedy, where work in `folder` could lose what others made: it is a symbolic link or a file, or something in
/// it is no file of the program's. Nothing there, and a folder without files, pass.
void expect_own_folder(const std::filesystem::path& folder, const IsOwnFile& is_own);

/// Removes `folder` and what is in it where expect_own_folder() lets it pass; otherwise, and where it cannot be removed, leaves it.
void remove_own_folder(const std::filesystem::path& folder, const IsOwnFile& is_own);

/// Whether `name` is that of a file or, as Aside calls it while it is written, "NAME.partial" or "NAME.partial.1".
bool is_called(const std::filesystem::path& name, const std::string& file);

}  // namespace actformer
