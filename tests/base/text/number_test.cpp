// parse_number against the C library, on a million renderings and on the odd ones.
#include "base/text/number.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/rounds.hpp"

namespace actformer {
namespace {

/// The characters that parse_number took, -1 where it refused; `text` stands before 8 zero bytes and no more.
std::ptrdiff_t taken(const std::string& text, double& value) {
    std::vector<char> bytes(text.begin(), text.end());
    bytes.resize(text.size() + 8);
    const char* end = parse_number(bytes.data(), value);
    return end ? end - bytes.data() : -1;
}

std::uint64_t bits(double value) {
    return std::bit_cast<std::uint64_t>(value);
}

std::string rendering(std::mt19937_64& random) {
    const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    const double sign = pick(2) ? 1 : -1;
    const double ordinary =
        sign * std::ldexp(static_cast<double>(random() >> 11), -53) * std::pow(10, pick(7) - 2);
    switch (pick(10)) {
        case 0:
            return fmt::format("{:.{}f}", ordinary, pick(20));
        case 1:
            return fmt::format("{:.6g}", ordinary);
        case 2:
            return fmt::format("{:+.{}e}", ordinary, pick(20));
        case 3:
            return fmt::format("{:.17g}", ordinary);
        case 4:
            return fmt::format("{}", static_cast<float>(ordinary));
        case 5:
            return fmt::format("{}", static_cast<std::int64_t>(random()));
        case 6:
            return fmt::format("{}", pick(1000));
        case 7:
            return fmt::format("{}.{}E{}", pick(1000000), random(), pick(640) - 320);
        case 8:
            return fmt::format(".{:0{}}", pick(1000), 1 + pick(30));
        default: {  // any double but those that are no number
            const double any = std::bit_cast<double>(random());
            return fmt::format("{:.{}g}", std::isfinite(any) ? any : 0.0, 1 + pick(25));
        }
    }
}

TEST(Number, AgreesWithTheCLibraryOnAMillionRenderings) {
    std::mt19937_64 random(20230);
    for (int i = 0; i < test::rounds(1'000'000); ++i) {
        const std::string text = rendering(random);
        const double want = std::strtod(text.c_str(), nullptr);
        double got = 0;
        const auto count = taken(text, got);
        if (std::isinf(want)) {
            ASSERT_EQ(count, -1) << text;
        } else {
            ASSERT_EQ(count, static_cast<std::ptrdiff_t>(text.size())) << text;
            ASSERT_EQ(bits(got), bits(want)) << text << " became " << got;
        }
    }
}

TEST(Number, StopsAtWhatIsNoPartOfIt) {
    const std::vector<std::pair<std::string, std::ptrdiff_t>> cases = {
        {"1.5 2.5", 3}, {"12\t", 2},      {"7\r\n", 1},    {"1,5", 1},       {"1.2.3", 3},
        {"3e", 1},      {"3e+", 1},       {"3e+x", 1},     {"3.", 2},        {"-.5", 3},
        {"+4", 2},      {"12345678:", 8}, {"0x10", 1},     {"1e5e6", 3},     {"5-6", 1},
        {"9\xC3", 1},   {"1\xBA\xBA", 1}, {"12345678", 8}, {"123456789/", 9}};
    for (const auto& [text, want] : cases) {
        double value = 0;
        EXPECT_EQ(taken(text, value), want) << text;
        EXPECT_EQ(value, std::strtod(text.substr(0, want).c_str(), nullptr)) << text;
    }
}

TEST(Number, RefusesWhatIsNoNumber) {
    for (const std::string text :
         {"",    " 1",   "-",   "+",         ".", "-.",    "--1",    "+-1",  "e5", ".e5", "nan",
          "NaN", "-nan", "inf", "-Infinity", "x", "1e999", "-1e309", "\xFF", ":",  "/"}) {
        double value = 17;
        EXPECT_EQ(taken(text, value), -1) << text;
        EXPECT_EQ(value, 17) << text;
    }
}

TEST(Number, KeepsTheSignOfZeroAndRoundsWhatIsTinyToIt) {
    double value = 1;
    EXPECT_EQ(taken("-0", value), 2);
    EXPECT_EQ(bits(value), bits(-0.0));
    EXPECT_EQ(taken("1e-999", value), 6);
    EXPECT_EQ(bits(value), bits(0.0));
    EXPECT_EQ(taken("-0.0000000000000001e-400", value), 24);
    EXPECT_EQ(bits(value), bits(-0.0));
    EXPECT_EQ(taken("5e-324", value), 6);
    EXPECT_EQ(value, std::numeric_limits<double>::denorm_min());
}

TEST(Number, TakesAnyNumberOfDigits) {
    double value = 0;
    EXPECT_EQ(taken(std::string(100'000, '0') + "1." + std::string(100'000, '0'), value), 200'002);
    EXPECT_EQ(value, 1);
    EXPECT_EQ(taken("0." + std::string(300, '0') + "25e301", value), 308);
    EXPECT_EQ(value, 2.5);
    EXPECT_EQ(taken("1e" + std::string(100'000, '9'), value), -1);
    EXPECT_EQ(taken(std::string(400, '9') + "e-5", value), -1);
    EXPECT_EQ(taken("1e-" + std::string(100'000, '9'), value), 100'003);
    EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace actformer
