// Checksums that stand in what they are of: a file's last line, or a member of a JSON object. A reader can tell whether it
// is as this program wrote it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/checksum/checksum.hpp"

namespace actformer {

/// What the checksum says of its file or object.
enum class OwnChecksum {
    absent,  ///< not this program's, or changed by another, which left it out
    right,
    wrong  ///< damaged; of JSON also taken out, where the object says that this program wrote it
};

/// "\nchecksum 0123..\n": what goes behind `bytes`. Readers of HDF5 pass over it, and drop it when they change the file.
std::string checksum_line(std::string_view bytes);
std::string checksum_line_of(const Checksum& bytes);

/// Whether what a file tells of the program that wrote it, as in "actformer 0.1.0", is this one. "actformer, the Python package" is not.
bool names_this_program(std::string_view program);

/// Whether such a line stands at the end of `bytes`, and is theirs.
OwnChecksum own_checksum(std::string_view bytes);

/// Whether such a line stands at the end of `bytes` or of a file, whatever it says. Throws Error where the file cannot be read.
bool has_checksum_line(std::string_view bytes);
bool has_checksum_line(const std::filesystem::path& path);

/// The same as own_checksum() of a file; of one without such a line only the end is read. Throws Error where it cannot be read.
OwnChecksum own_checksum_of_file(const std::filesystem::path& path);

}  // namespace actformer
