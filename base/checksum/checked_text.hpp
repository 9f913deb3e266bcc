// Texts in which # begins a comment, such as YAML, with a checksum of all lines before it in the last one.
#pragma once

#include <filesystem>
#include <string>

namespace actformer {

/// The text, whose last line has an end, with "# checksum 0123.." as one more line.
std::string with_checksum_comment(std::string text);

/// Throws Error, naming the file, where its last line is the checksum of another text. One without such a line is taken as it is.
void expect_checksum_comment(const std::filesystem::path& path);

}  // namespace actformer
