// The bytes of a pickle, taken from the front.
#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "base/error.hpp"

namespace actformer {

/// Functions throw Error where the text ends before what they are to take.
class PickleText {
  public:
    explicit PickleText(std::string_view all) : all_(all) {}

    /// Where the opcode in hand stands: errors name it.
    std::uint64_t opcode_at() const { return opcode_at_; }
    const char* here() const { return all_.data() + at_; }
    std::uint64_t left() const { return all_.size() - at_; }

    unsigned char opcode() {
        opcode_at_ = at_;
        return number<unsigned char>();
    }

    std::string_view take(std::uint64_t bytes) {
        if (bytes > left())
            throw Error("byte {}: {} bytes are to follow, and the file has {} more: cut short", opcode_at_,
                        bytes, left());
        const auto taken = all_.substr(at_, bytes);
        at_ += bytes;
        return taken;
    }

    /// Little-endian.
    template <std::integral Number>
    Number number() {
        Number out;
        std::memcpy(&out, take(sizeof out).data(), sizeof out);
        return out;
    }

    /// Up to the end of the line, which is taken too.
    std::string_view line() {
        const auto end = all_.find('\n', at_);
        if (end == std::string_view::npos)
            throw Error("byte {}: a line without an end: cut short", opcode_at_);
        const auto taken = all_.substr(at_, end - at_);
        at_ = end + 1;
        return taken;
    }

  private:
    std::string_view all_;
    std::uint64_t at_ = 0, opcode_at_ = 0;
};

/// 'a\'b\x00' as Python 2 spells a byte string in a line. Throws Error, without a place, where it is no such thing.
std::string of_quoted_bytes(std::string_view line);

/// A Unicode text as protocol 0 spells it in a line, \u00e4 for characters, as UTF-8. Throws Error, without a place, where it is none.
std::string of_escaped_unicode(std::string_view line);

/// Bytes whose values are the characters of a UTF-8 text. Throws Error, without a place, where a character is above 255.
std::string latin1_of(std::string_view utf8);

}  // namespace actformer
