#include "base/text/printable.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "base/text/utf8.hpp"

namespace actformer {
namespace {

/// Ends a line or turns the direction of writing, unseen.
bool moves_text(std::uint32_t code) {
    return code == 0x61C || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
           (code >= 0x2066 && code <= 0x2069);
}

/// Bytes of the printable character that `text` starts with; 0 where there is none.
std::size_t printable_bytes(std::string_view text) {
    const auto character = first_character(text);
    return !character || is_control(character->code) || moves_text(character->code) ? 0 : character->bytes;
}

}  // namespace

std::string printable(std::string_view bytes) {
    std::string out;
    while (!bytes.empty()) {
        const std::size_t length = printable_bytes(bytes);
        if (length > 0)
            out += bytes.substr(0, length);
        else
            out += fmt::format("\\x{:02X}", static_cast<unsigned char>(bytes[0]));
        bytes.remove_prefix(length > 0 ? length : 1);
    }
    return out;
}

std::string in_quotes(std::string_view bytes) {
    constexpr std::size_t longest = 40;
    return fmt::format("'{}{}'", printable(bytes.substr(0, longest)), bytes.size() > longest ? "..." : "");
}

}  // namespace actformer
