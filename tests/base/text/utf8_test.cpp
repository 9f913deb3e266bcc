// Characters in UTF-8, there and back.
#include <gtest/gtest.h>

#include "base/text/utf8.hpp"

using namespace actformer;

namespace {

bool is_surrogate(std::uint32_t code) {
    return code >= 0xD800 && code <= 0xDFFF;
}

}  // namespace

TEST(Utf8, EveryCharacterIsReadAsItWasWritten) {
    for (std::uint32_t code = 0; code <= 0x10FFFF; ++code) {
        std::string text;
        ASSERT_TRUE(append_utf8(code, text));
        const auto bytes = text.size();
        const auto read = first_character(text + "a");
        ASSERT_EQ(read.has_value(), !is_surrogate(code)) << code;
        if (!read) continue;
        ASSERT_EQ(read->code, code);
        ASSERT_EQ(read->bytes, bytes) << code;
    }
}

TEST(Utf8, BytesThatAreNoCharacterAreNone) {
    for (const std::string_view text :
         {"", "\x80", "\xBF", "\xC0\x80", "\xC1\xBF", "\xC3", "\xC3(", "\xE0\x9F\xBF", "\xE2\x82",
          "\xE2\x82(", "\xED\xA0\x80", "\xF0\x8F\xBF\xBF", "\xF0\x9F\x98", "\xF4\x90\x80\x80",
          "\xF5\x80\x80\x80", "\xFF"})
        EXPECT_FALSE(first_character(text)) << testing::PrintToString(text);
}

TEST(Utf8, ControlCharactersAreThoseOfC0AndC1) {
    for (std::uint32_t code = 0; code < 0x200; ++code)
        EXPECT_EQ(is_control(code), code <= 0x1F || (code >= 0x7F && code <= 0x9F)) << code;
}
