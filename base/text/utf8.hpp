// Characters as UTF-8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace actformer {

struct Utf8Character {
    std::uint32_t code;
    std::size_t bytes;
};

/// The one that `text` begins with; nothing where it is empty, or begins with bytes that are no character: broken ones, longer than
/// need be, surrogates, beyond Unicode (RFC 3629).
std::optional<Utf8Character> first_character(std::string_view text);

/// C0 and C1 control characters, and DEL.
bool is_control(std::uint32_t code);

/// False, and nothing added, where there is no such character.
bool append_utf8(std::uint32_t character, std::string& text);

}  // namespace actformer
