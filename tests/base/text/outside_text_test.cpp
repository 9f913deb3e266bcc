// Text from outside on its way to a terminal, to a spreadsheet and through a parser of JSON.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/text/csv.hpp"
#include "base/text/json.hpp"
#include "base/text/printable.hpp"
#include "tests/support/error_of.hpp"

using namespace actformer;

TEST(Printable, EscapesWhatATerminalObeysAndKeepsTheRest) {
    EXPECT_EQ(printable("Größe 3 – ходьба, 歩く"), "Größe 3 – ходьба, 歩く");
    EXPECT_EQ(printable("a\x1b]0;title\x07\nb"), "a\\x1B]0;title\\x07\\x0Ab");
    EXPECT_EQ(printable("clip\xE2\x80\xAEgpj.exe"),
              "clip\\xE2\\x80\\xAEgpj.exe");  // U+202E: from right to left
    EXPECT_EQ(printable("\xE2\x81\xA6\xE2\x80\xA8\xD8\x9C"), "\\xE2\\x81\\xA6\\xE2\\x80\\xA8\\xD8\\x9C");
    EXPECT_EQ(printable("\xFF\xC2"), "\\xFF\\xC2");
    const std::string once = printable("\x1b[2J");
    EXPECT_EQ(printable(once), once) << "what is escaped stays as it is";
}

TEST(Error, IsOneLineWhateverItNames) {
    const Error error("{}: cannot be read", "raw\nactformer: all is well\x1b[2J");
    EXPECT_STREQ(error.what(), "raw\\x0Aactformer: all is well\\x1B[2J: cannot be read");
}

TEST(Csv, QuotesCellsAndDisarmsFormulas) {
    EXPECT_EQ(csv_cell("walk"), "walk");
    EXPECT_EQ(csv_cell("sit, \"down\""), "\"sit, \"\"down\"\"\"");
    EXPECT_EQ(csv_cell("two\nlines"), "\"two\nlines\"");
    EXPECT_EQ(csv_cell("=HYPERLINK(\"http://x\")"), "\"'=HYPERLINK(\"\"http://x\"\")\"");
    for (const std::string start : {"+", "-", "@", "\t"}) EXPECT_EQ(csv_cell(start + "1"), "'" + start + "1");
    EXPECT_EQ(csv_cell("a=b"), "a=b");
    EXPECT_EQ(csv_cell(""), "");
}

TEST(Json, IsBoundedInDepth) {
    const auto nested = [](std::size_t depth) {
        return std::string(depth, '[') + "\n" + std::string(depth, ']');
    };
    EXPECT_FALSE(line_too_deep(nested(deepest_json)));
    EXPECT_EQ(line_too_deep(nested(deepest_json + 1)), 1U);
    EXPECT_EQ(line_too_deep("\n\n{\"a\":" + nested(deepest_json)), 3U);
    EXPECT_FALSE(line_too_deep("[\"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\"]"));
    std::string wide = "[";
    for (int i = 0; i < 1000; ++i) wide += "[],{},";
    EXPECT_FALSE(line_too_deep(wide + "0]"));
    EXPECT_TRUE(json_or_discarded<nlohmann::json>(nested(200'000)).is_discarded());
    EXPECT_TRUE(json_or_discarded<nlohmann::json>("[1").is_discarded());
    EXPECT_EQ(json_or_discarded<nlohmann::json>("[1]"), nlohmann::json::parse("[1]"));
    const auto error =
        test::error_of([&] { expect_shallow_json("[\n" + nested(200'000), "x/dataset.json"); });
    EXPECT_NE(error.find("x/dataset.json: line 2: "), std::string::npos) << error;
}
