#include "base/text/three_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "base/text/lines.hpp"
#include "base/text/number.hpp"
#include "tests/support/rounds.hpp"

using namespace actformer;

namespace {

struct Way {
    const char* name;
    bool (*read)(const char*, std::uint64_t, Point&);
};
const Way ways[] = {{"the machine's own", read_three_plainly}, {"one by one", read_three_one_by_one}};

/// The 64 characters that a line begins with, and more to read.
std::string padded(std::string line) {
    line.resize(std::max<std::size_t>(line.size(), 64), ' ');
    return line + std::string(64, '\0');
}

bool read(const Way& way, const std::string& line, Point& values) {
    const auto text = padded(line);
    return way.read(text.data(), masks_of_64(text.data()).blank, values);
}

std::string random_number(std::mt19937& random, int places) {
    std::string number = random() % 2 ? "-" : "";
    number += static_cast<char>('0' + random() % 10);
    number += '.';
    for (int i = 0; i < places; ++i) number += static_cast<char>('0' + random() % 10);
    return number;
}

/// What all ways must agree with: three numbers followed by blanks, one after the other.
bool read_slowly(const std::string& line, Point& values) {
    const auto text = padded(line);
    const char *p = text.data(), *end = p + 64;
    for (std::size_t d = 0; d < 3; ++d) {
        p = skip_blanks(p, end);
        p = p < end ? parse_number(p, values[d]) : nullptr;
        if (!p || static_cast<unsigned char>(*p) > ' ' || p >= end) return false;
    }
    return true;
}

void expect_same(const Way& way, const std::string& line, const Point& values) {
    Point expected{};
    ASSERT_TRUE(read_slowly(line, expected)) << way.name << " took '" << line << "'";
    for (std::size_t d = 0; d < 3; ++d) {
        ASSERT_NEAR(values[d], expected[d], std::abs(expected[d]) * 5e-16) << way.name << ": " << line;
        ASSERT_EQ(std::signbit(values[d]), std::signbit(expected[d])) << way.name << ": " << line;
    }
}

}  // namespace

TEST(ThreeNumbers, AreReadInEveryLengthAndPlace) {
    std::mt19937 random(1);
    for (int round = 0; round < test::rounds(50000); ++round) {
        std::string line(round % 7 == 0 ? random() % 5 : 0, ' ');
        for (int i = 0; i < 3; ++i)
            line += random_number(random, 1 + static_cast<int>(random() % 8)) +
                    std::string(round % 3 ? 1 : 1 + random() % 3, round % 5 ? ' ' : '\t');
        line += "277.419 191.8218 1036.233 -0.2 x";
        for (const auto& way : ways) {
            Point values{};
            ASSERT_TRUE(read(way, line, values)) << way.name << ": " << line;
            expect_same(way, line, values);
        }
    }
}

TEST(ThreeNumbers, AreReadRightOrNotAtAllWhateverTheText) {
    std::mt19937 random(2);
    const std::string characters = "0123456789.- \te+,\xB2";
    int taken = 0;
    for (int round = 0; round < test::rounds(400000); ++round) {
        std::string line;
        for (int i = 0; i < 3; ++i) line += random_number(random, static_cast<int>(random() % 18)) + " ";
        line += "1 2 3";
        for (auto changes = random() % 4; changes > 0; --changes)
            line[random() % line.size()] = characters[random() % characters.size()];
        for (const auto& way : ways) {
            Point values{};
            if (!read(way, line, values)) continue;
            ++taken;
            expect_same(way, line, values);
        }
    }
    EXPECT_GT(taken, test::rounds(10000));
}

TEST(ThreeNumbers, MustEndWithinTheCharacters) {
    const std::string most(50, ' ');
    for (const auto& way : ways) {
        Point values{};
        EXPECT_TRUE(read(way, most + "1.5 2.5 -3.25 7", values)) << way.name;
        EXPECT_FALSE(read(way, most + "1.5 2.5 -3.2555", values)) << way.name;
        EXPECT_FALSE(read(way, most + "1.5 2.5", values)) << way.name;
        EXPECT_FALSE(read(way, "", values)) << way.name;
    }
}
