#include "base/text/lines.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

using namespace actformer;

namespace {

/// A text with the 64 zero bytes that readers may rely on.
struct Padded {
    explicit Padded(const std::string& text) : bytes(text + std::string(64, '\0')), size(text.size()) {}
    const char* begin() const { return bytes.data(); }
    const char* end() const { return bytes.data() + size; }
    std::string bytes;
    std::size_t size;
};

}  // namespace

TEST(Lines, MasksAreTheSameInEveryWidth) {
    std::mt19937 random(1);
    for (int round = 0; round < 2000; ++round) {
        char text[64];
        for (char& c : text) c = random() % 4 ? static_cast<char>(random()) : " \n\t\r\0"[random() % 5];
        const auto fast = masks_of_64(text), plain = masks_of_64_plain(text);
        ASSERT_EQ(fast.newline, plain.newline);
        ASSERT_EQ(fast.blank, plain.blank);
    }
}

TEST(Lines, CountsFieldsUpToTheNewlineOfLinesOfAnyLength) {
    std::mt19937 random(2);
    for (int round = 0; round < 3000; ++round) {
        std::string line;
        const int fields = static_cast<int>(random() % 20);
        for (int f = 0; f < fields; ++f)
            line += std::string(f == 0 ? random() % 2 : 1 + random() % 3, ' ') +
                    std::string(1 + random() % 30, 'x');
        line += std::string(random() % 3, '\t') + (random() % 2 ? "\r" : "");
        const bool last = random() % 4 == 0;
        const Padded text(last ? line : line + "\nnext line");
        int found = -1;
        const char* stop = end_of_line(text.begin(), text.end(), found);
        ASSERT_EQ(found, fields) << line;
        ASSERT_EQ(stop, text.begin() + line.size());
    }
}

TEST(Lines, StopsAtTheEndOfTheTextWhateverLiesBehind) {
    const std::string bytes = "1 2 3" + std::string(100, '7') + "\n";
    int fields = 0;
    EXPECT_EQ(end_of_line(bytes.data(), bytes.data() + 5, fields), bytes.data() + 5);
    EXPECT_EQ(fields, 3);
}

TEST(Lines, SkipsAByteOrderMark) {
    EXPECT_EQ(without_bom("\xEF\xBB\xBF"
                          "12"),
              "12");
    EXPECT_EQ(without_bom("12"), "12");
}
