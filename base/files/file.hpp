// Files that are read whole and written whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/aside.hpp"

namespace actformer {

/// Zero bytes behind every text in memory: readers may load this far past its end.
constexpr std::size_t text_padding = 64;

/// The text of `path` in `scratch` (which only ever grows), followed by text_padding zero bytes.
/// Throws Error where it cannot be read or is larger than `limit` bytes, NoMemoryFor where there is no memory for it.
std::string_view read_text(const std::filesystem::path& path, std::vector<char>& scratch,
                           std::uint64_t limit);

/// Calls `use` with a file's bytes in order, a megabyte or so at a time. Throws Error where it cannot be read.
void read_in_pieces(const std::filesystem::path& path, const std::function<void(std::string_view)>& use);

/// Direct writes, past the page cache, begin at a multiple of this and are a multiple of it long.
constexpr std::size_t direct_block = 4096;

/// An Aside with these bytes. Throws Error (no space, no right to write) and leaves nothing behind.
void write_whole(const std::filesystem::path& path, std::string_view bytes, Sync sync = Sync::now);

/// Puts `bytes` behind what is in the file, which is made where there is none. Throws Error, and takes back what was written of them,
/// where not all of them could be, and where a symbolic link or no regular file is there.
void append(const std::filesystem::path& path, std::string_view bytes);

/// Makes the folder and those it lies in; where `folder` is a symbolic link, what that leads to. Throws Error.
void make_folders(const std::filesystem::path& folder);

}  // namespace actformer
