#include "base/pickle/text.hpp"

#include "base/text/utf8.hpp"

namespace actformer {
namespace {

[[noreturn]] void malformed() {
    throw Error("a text that is not spelled as Python spells it");
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    malformed();
}

std::uint32_t hex(std::string_view text, std::size_t from, std::size_t digits) {
    if (from + digits > text.size()) malformed();
    std::uint32_t value = 0;
    for (const char c : text.substr(from, digits))
        value = value << 4 | static_cast<std::uint32_t>(hex_digit(c));
    return value;
}

/// What one letter behind a backslash stands for.
char escaped(char letter) {
    constexpr std::string_view letters = "\\'\"abfnrtv", stand_for = "\\'\"\a\b\f\n\r\t\v";
    const auto found = letters.find(letter);
    if (found == std::string_view::npos) malformed();
    return stand_for[found];
}

}  // namespace

std::string of_quoted_bytes(std::string_view line) {
    if (line.size() < 2 || (line[0] != '\'' && line[0] != '"') || line.back() != line[0]) malformed();
    line = line.substr(1, line.size() - 2);
    std::string out;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] != '\\') {
            out += line[i];
        } else if (++i == line.size()) {
            malformed();
        } else if (line[i] == 'x') {
            out += static_cast<char>(hex(line, i + 1, 2));
            i += 2;
        } else {
            out += escaped(line[i]);
        }
    }
    return out;
}

std::string of_escaped_unicode(std::string_view line) {
    std::string out;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool is_escape =
            line[i] == '\\' && i + 1 < line.size() && (line[i + 1] == 'u' || line[i + 1] == 'U');
        if (!is_escape) {
            append_utf8(static_cast<unsigned char>(line[i]), out);
            continue;
        }
        const std::size_t digits = line[i + 1] == 'u' ? 4 : 8;
        if (!append_utf8(hex(line, i + 2, digits), out)) malformed();
        i += 1 + digits;
    }
    return out;
}

std::string latin1_of(std::string_view utf8) {
    std::string out;
    out.reserve(utf8.size());
    while (!utf8.empty()) {
        const auto character = first_character(utf8);
        if (!character || character->code > 0xFF)
            throw Error("bytes written as a text with a character above 255");
        out += static_cast<char>(character->code);
        utf8.remove_prefix(character->bytes);
    }
    return out;
}

}  // namespace actformer
