#include "ingest/formats/gta/jta_file.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

using namespace actformer::ingest;

namespace {

std::string row(int frame, int person, int joint) {
    return fmt::format("[{}, {}, {}, 960.5, 540, {}, {}, {}, 0, 1]", frame, person, joint,
                       0.1 * joint + person, -0.5, 4e0 + frame);
}

std::variant<JtaFile, Rejection> read(std::string text) {
    text.append(64, '\0');
    return read_jta(std::string_view(text).substr(0, text.size() - 64));
}

std::string fault(const std::string& text) {
    const auto said = read(text);
    const auto* rejection = std::get_if<Rejection>(&said);
    return rejection ? rejection->reason : "taken";
}

}  // namespace

TEST(JtaFile, GathersRowsInAnyOrder) {
    std::string rows;
    for (int joint = 21; joint >= 0; --joint) {
        for (const int frame : {7, 5})
            for (const int person : {900, 3}) rows += row(frame, person, joint) + ",\n";
        rows += row(6, 3, joint) + ",";
    }
    rows += row(8, 3, 0) + "," + row(9, 900, 4) + "," + row(9, 41, 4);  // not all of the joints
    const auto said = read(" [" + rows + "]\n");
    const auto& file = std::get<JtaFile>(said);
    EXPECT_EQ(file.frames, 5U);      // 5 to 9
    EXPECT_EQ(file.incomplete, 1U);  // 41
    ASSERT_EQ(file.persons.size(), 2U);
    EXPECT_EQ(file.persons[0].id, 3);
    EXPECT_EQ(file.persons[0].times, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(file.persons[1].times, (std::vector<std::uint32_t>{0, 2}));
    const double* joint = &file.persons[1].positions[22 * 3 + 3 * 20];
    EXPECT_DOUBLE_EQ(joint[0], 902);
    EXPECT_DOUBLE_EQ(joint[1], -0.5);
    EXPECT_DOUBLE_EQ(joint[2], 11);
    EXPECT_TRUE(std::get<JtaFile>(read("[]")).persons.empty());
}

TEST(JtaFile, NamesTheRowAtFault) {
    const auto first = "[" + row(1, 1, 0);
    EXPECT_EQ(fault(""), "row 0: the end of the text in place of '['");
    EXPECT_EQ(fault("{}"), "row 0: '{' in place of '['");
    EXPECT_EQ(fault(first), "row 1: the end of the text in place of ']'");
    EXPECT_EQ(fault(first + ", [1, 2"), "row 1: the end of the text in place of ','");
    EXPECT_EQ(fault(first + ", [1, 1, 1, 0, 0, 0, 0, 0]]"), "row 1: ']' in place of ','");
    EXPECT_EQ(fault(first + ", [1, 1, null"), "row 1: 'n' in place of a number");
    EXPECT_EQ(fault(first + "," + row(1, 1, 22) + "]"), "row 1: 22 is no joint of JTA's 22");
    EXPECT_EQ(fault(first + "," + row(-1, 1, 2) + "]"), "row 1: -1 is no number of a frame");
    EXPECT_EQ(fault(first + "," + first.substr(1) + "]"),
              "row 1: joint 0 of person 1 comes twice in frame 1");
    EXPECT_EQ(fault("[[1, 1, 0, 0, 0, 1e7, 0, 0, 0, 0]]"), "row 0: 10000000 is no position in metres");
    EXPECT_EQ(fault("[[1.5, 1, 0, 0, 0, 1, 0, 0, 0, 0]]"), "row 0: 1.5 is no number of a frame");
    EXPECT_EQ(fault(first + "] 7"), "row 1: more behind the list of rows");
}
