// Characters as UTF-8.
#pragma once

#include <cstdint>
#include <string>

namespace actformer {

/// False, and nothing added, where there is no such character.
bool append_utf8(std::uint32_t character, std::string& text);

}  // namespace actformer
