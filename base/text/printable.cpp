#include "base/text/printable.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace actformer {
namespace {

/// Ends a line or turns the direction of writing, unseen.
bool moves_text(std::uint32_t code) {
    return code == 0x61C || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
           (code >= 0x2066 && code <= 0x2069);
}

/// Bytes of the printable character that `text` starts with; 0 where there is none.
std::size_t character(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
    const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
    std::uint32_t code = first & (0xFFU >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        const auto next = static_cast<unsigned char>(text[i]);
        if ((next & 0xC0) != 0x80) return 0;
        code = code << 6 | (next & 0x3FU);
    }
    const std::uint32_t least = length == 4 ? 0x10000 : length == 3 ? 0x800 : 0x80;
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF, control = code < 0xA0;
    return code < least || code > 0x10FFFF || surrogate || control || moves_text(code) ? 0 : length;
}

}  // namespace

std::string printable(std::string_view bytes) {
    std::string out;
    while (!bytes.empty()) {
        const std::size_t length = character(bytes);
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
