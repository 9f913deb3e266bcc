#include "base/text/utf8.hpp"

namespace actformer {

bool append_utf8(std::uint32_t character, std::string& text) {
    if (character > 0x10FFFF) return false;
    const auto byte = [&](std::uint32_t bits) { text += static_cast<char>(bits); };
    const auto next = [&](int shift) { byte(0x80 | (character >> shift & 0x3F)); };
    if (character < 0x80) {
        byte(character);
        return true;
    }
    if (character < 0x800) {
        byte(0xC0 | character >> 6);
    } else if (character < 0x10000) {
        byte(0xE0 | character >> 12);
        next(6);
    } else {
        byte(0xF0 | character >> 18);
        next(12);
        next(6);
    }
    next(0);
    return true;
}

}  // namespace actformer
