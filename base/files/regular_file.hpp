// Telling files from what only looks like one in a folder.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/files/descriptor.hpp"

namespace actformer {

/// Throws Error for a folder, FIFO, socket or device: opening such a thing may wait for ever. What is not there passes.
void refuse_irregular(const std::filesystem::path& path);

struct Readable {
    Descriptor file;
    std::uint64_t size = 0;  ///< bytes
};

/// Opens for reading. Throws Error, and waits for nobody, where a link leads to or `path` is anything else than a regular file, and where it
/// cannot be opened.
Readable open_to_read(const std::filesystem::path& path);

/// Opens as open(2) does, for files that this program alone makes: get() is negative, and errno says why, where that fails. Throws
/// Error, and waits for nobody, where a symbolic link or anything else than a regular file is there.
Descriptor open_regular(const std::filesystem::path& path, int flags);

/// "a FIFO", "a folder", ...; empty for a regular file, a link to one, and what is not there.
const char* irregular_kind(const std::filesystem::path& path);

}  // namespace actformer
