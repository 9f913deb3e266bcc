// Telling files from what only looks like one in a folder.
#pragma once

#include <filesystem>

namespace actformer {

/// Throws Error for a folder, FIFO, socket or device: opening such a thing may wait for ever. What is not there passes.
void refuse_irregular(const std::filesystem::path& path);

/// "a FIFO", "a folder", ...; empty for a regular file, a link to one, and what is not there.
const char* irregular_kind(const std::filesystem::path& path);

}  // namespace actformer
