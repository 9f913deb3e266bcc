// Logs whose lines have checksums: no changed byte of one passes for what was written.
#include "base/checksum/checked_lines.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;
using Json = nlohmann::ordered_json;

namespace {

/// What a reader takes from a line: its numbers.
std::vector<std::map<std::string, double>> numbers_of(const CheckedLines& lines) {
    std::vector<std::map<std::string, double>> out;
    for (const auto& object : lines.objects) {
        auto& line = out.emplace_back();
        for (const auto& [key, value] : object.items())
            if (value.is_number()) line[key] = value;
    }
    return out;
}

/// Two lines, the first with this number.
std::string lines_from(std::size_t number) {
    return checked_line({{"epoch", 1}, {"loss", 0.125}, {"score", -1e-9}}, number) +
           checked_line({{"epoch", 2}, {"loss", 0.0625}, {"score", nullptr}}, number + 1);
}

const std::string two_lines = lines_from(1);

}  // namespace

TEST(CheckedLines, AreReadBackAsTheyWereWritten) {
    const TempDir dir;
    EXPECT_TRUE(read_checked_lines(dir / "none").objects.empty());
    const std::string earlier = "{\"epoch\":0,\"loss\":0.5}\n";
    write_file(dir / "log", earlier + lines_from(2));
    const auto lines = read_checked_lines(dir / "log");
    ASSERT_EQ(lines.objects.size(), 3U);
    EXPECT_EQ(lines.fault("log"), "");
    EXPECT_EQ(lines.objects[0].dump() + "\n", earlier);
    EXPECT_EQ(checked_line(lines.objects[1], 2) + checked_line(lines.objects[2], 3), lines_from(2));
    const auto line = checked_line({{"epoch", 1}}, 7);
    EXPECT_TRUE(line.starts_with("{\"epoch\":1,\"line\":7,\"checksum\":\"")) << line;
    EXPECT_TRUE(line.ends_with("\"}\n")) << line;
}

TEST(CheckedLines, TellOfEveryByteThatChangesWhatTheySay) {
    const TempDir dir;
    write_file(dir / "log", two_lines);
    const auto right = numbers_of(read_checked_lines(dir / "log"));
    for (std::size_t at = 0; at < two_lines.size(); ++at)
        for (const int flip : {1, 2, 16, 128}) {
            auto text = two_lines;
            text[at] = static_cast<char>(text[at] ^ flip);
            write_file(dir / "log", text);
            const auto lines = read_checked_lines(dir / "log");
            EXPECT_TRUE(numbers_of(lines) == right || !lines.fault("log").empty()) << text;
        }
}

TEST(CheckedLines, SayWhichAreDamagedAndWhetherTheLastIsCutShort) {
    const TempDir dir;
    auto text = two_lines;
    text[text.find("0.0625")] = '1';
    write_file(dir / "log", text + "[1]\n" + two_lines.substr(0, 20));
    const auto lines = read_checked_lines(dir / "log");
    EXPECT_EQ(lines.damaged, (std::vector<std::size_t>{2, 3}));
    EXPECT_EQ(lines.fault("x/log"), "x/log: lines 2, 3: damaged");
    for (std::size_t size = 0; size <= two_lines.size(); ++size) {
        write_file(dir / "log", two_lines.substr(0, size));
        const auto cut = read_checked_lines(dir / "log");
        const auto first = two_lines.find('\n');
        const bool whole = size == 0 || size == first || size == first + 1 || size + 1 >= two_lines.size();
        EXPECT_EQ(cut.fault("log"), whole ? "" : "log: its last line is cut short") << size;
    }
    std::filesystem::create_directory(dir / "folder");
    EXPECT_NE(error_of([&] { read_checked_lines(dir / "folder"); }).find("folder: a folder, where"),
              std::string::npos);
}

TEST(CheckedLines, SayWhereOthersAreMissing) {
    const TempDir dir;
    std::vector<std::string> lines;
    for (std::size_t i = 1; i <= 5; ++i) lines.push_back(checked_line({{"epoch", i}}, i));
    const auto fault_of = [&](std::initializer_list<std::size_t> kept) {
        std::string text;
        for (const auto i : kept) text += lines[i - 1];
        write_file(dir / "log", text);
        return read_checked_lines(dir / "log").fault("log");
    };
    EXPECT_EQ(fault_of({1, 2, 3, 4, 5}), "");
    EXPECT_EQ(fault_of({2, 3, 4, 5}), "log: lines are missing before line 1");
    EXPECT_EQ(fault_of({1, 3, 5}), "log: lines are missing before lines 2, 3");
    EXPECT_EQ(fault_of({1, 2, 2, 3}), "log: line 3: damaged");
    EXPECT_EQ(fault_of({2, 1, 3}), "log: lines are missing before line 1; line 2: damaged");
}
