// Where what is written at a path ends up.
#pragma once

#include <filesystem>

namespace actformer {

struct Output {
    std::filesystem::path file;  ///< behind all symbolic links
    bool stream = false;         ///< a device or a FIFO, written to as it is: no other file takes its place
};

/// What the links at `path` lead to, whether it is there or not.
std::filesystem::path without_links(std::filesystem::path path);

/// Throws Error, naming `path` and a remedy, where no file can be there: no folder to hold it, a folder itself, a disk, a socket.
Output output_at(const std::filesystem::path& path);

/// Throws Error where nothing can be written at `path`, before the work and not after it. Leaves nothing behind.
void check_output(const std::filesystem::path& path);

}  // namespace actformer
