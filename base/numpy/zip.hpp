// The members of a zip archive that lies in memory (APPNOTE 6.3), stored or deflated: stored ones are read where they lie.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace actformer {

struct ZipMember {
    std::string name;
    bool deflated = false;
    std::uint32_t checksum = 0;  ///< CRC-32 of its text
    std::uint64_t size = 0;      ///< bytes of its text, as the archive says
    std::string_view stored;     ///< what of it lies in the archive
};

/// By the list at the archive's end, in its order; a member's place and size are those of the list. Throws Error where there is none, as in
/// an archive cut short, and, naming the member, where one lies beyond the archive, is encrypted, or is compressed in another way.
std::vector<ZipMember> zip_members(std::string_view archive);

/// The first `most` bytes of the member's text, or all: in the archive, or inflated into `memory`. A size that the archive invents costs no
/// memory. Throws Error where the text is damaged; what is not read to its end is not checked.
std::string_view zip_text(const ZipMember& member, std::vector<char>& memory, std::uint64_t most);

}  // namespace actformer
