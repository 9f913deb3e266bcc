// Files that joblib compressed as a whole.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace actformer {

/// The text of a zlib, gzip, bzip2, xz or lzma stream, or of one behind old joblib's ZF header; none where
/// `text` begins like none of them. Throws Error where it is damaged or cut short, or holds more than `most` bytes.
std::optional<std::string> unpacked(std::string_view text, std::uint64_t most);

}  // namespace actformer
