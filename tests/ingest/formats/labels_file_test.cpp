// Tables of labels: what is taken, which rows a file gets, and what is refused.
#include "ingest/formats/labels_file.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/thread_seconds.hpp"

namespace actformer::ingest {
namespace {

using Names = std::vector<std::string>;
using Rows = std::vector<std::size_t>;

LabelsFile labels(const std::string& text) {
    return LabelsFile(text, "labels.csv");
}

std::string refusal(const std::string& text) {
    try {
        labels(text);
    } catch (const Error& e) {
        return e.what();
    }
    return "taken";
}

TEST(LabelsFile, ReadsColumnsByName) {
    const auto file = labels(
        "\xEF\xBB\xBF"
        "subject,file,action,description,start_frame,end_frame\r\n"
        "2,hips31/02/02_01.bvh,walk,\"walk, \"\"slowly\"\"\",1,344\r\n"
        "\n"
        "3,b.bvh,run,\"two\nlines\",,\n"
        "4,c,sit,,7,");
    EXPECT_EQ(file.fields(), (Names{"action", "subject", "description"}));
    ASSERT_EQ(file.rows().size(), 3U);
    const auto& first = file.rows()[0];
    EXPECT_EQ(first.file, "hips31/02/02_01.bvh");
    EXPECT_EQ(first.action, "walk");
    EXPECT_EQ(first.start, 1U);
    EXPECT_EQ(first.end, 344U);
    EXPECT_EQ(first.fields, (Names{"walk", "2", "walk, \"slowly\""}));
    EXPECT_EQ(file.rows()[1].fields[2], "two\\x0Alines");
    EXPECT_EQ(file.rows()[1].start, std::nullopt);
    EXPECT_EQ(file.rows()[2].start, 7U);
    EXPECT_EQ(file.rows()[2].end, std::nullopt);
}

TEST(LabelsFile, LeavesOutBlanksAroundValues) {
    const auto file = labels(
        "name , label,  style\r\n"
        "a, walk,slow \r\n"
        "b\t,walk,\tvery  slow\n"
        "  \n"
        "c, \" walk, away \" ,\n"
        "d,walk, ");
    EXPECT_EQ(file.fields(), (Names{"action", "style"}));
    ASSERT_EQ(file.rows().size(), 4U);
    EXPECT_EQ(file.rows()[0].fields, (Names{"walk", "slow"}));
    EXPECT_EQ(file.rows()[1].file, "b");
    EXPECT_EQ(file.rows()[1].fields, (Names{"walk", "very  slow"}));
    EXPECT_EQ(file.rows()[2].fields, (Names{" walk, away ", ""})) << "in quotes they are part of the value";
    EXPECT_EQ(file.rows()[3].fields, (Names{"walk", ""}));
    const auto tabs = labels("name\tlabel\tstyle\na\t walk \t\n");
    EXPECT_EQ(tabs.rows()[0].fields, (Names{"walk", ""})) << "a tab between columns is no blank";
    EXPECT_EQ(refusal("file,action\na,  \n"), "labels.csv: line 2: no action; give every row both");
}

TEST(LabelsFile, TakesAClassForTheActionWhereNoColumnIsCalledSo) {
    const auto alone = labels("name,class,style\na,walk,slow\n");
    EXPECT_EQ(alone.rows()[0].action, "walk");
    EXPECT_EQ(alone.fields(), (Names{"action", "style"}));
    for (const std::string header : {"file,class,action\n", "file,class,label\n"}) {
        const auto beside = labels(header + "a,outdoors,walk\n");
        EXPECT_EQ(beside.rows()[0].action, "walk") << header;
        EXPECT_EQ(beside.fields(), (Names{"action", "class"})) << header;
        EXPECT_EQ(beside.rows()[0].fields, (Names{"walk", "outdoors"})) << header;
    }
}

TEST(LabelsFile, FindsTheRowsOfAFile) {
    const auto file =
        labels("file,label\na/01.bvh,walk\nb/01.BVH,run\n01,sit\n02.bvh,jump\n02.bvh,hop\n./03,fly\n");
    EXPECT_EQ(file.find("/data/a/01"), Rows{0});
    EXPECT_EQ(file.find("/data/b/01.bvh"), Rows{1});
    EXPECT_EQ(file.find("ba/01"), Rows{2});  // a/01 is no part of it
    EXPECT_EQ(file.find("01"), Rows{2});
    EXPECT_EQ(file.find("x/02"), (Rows{3, 4}));
    EXPECT_EQ(file.find("x/03"), Rows{5});
    EXPECT_EQ(file.find("x/04"), Rows{});
}

TEST(LabelsFile, FindsFilesOfOneNameInManyFoldersInNoTime) {
    constexpr std::size_t files = 100'000;
    std::string text = "file,label\n";
    for (std::size_t i = 0; i < files; ++i) text += fmt::format("take{}/motion.bvh,walk\n", i);
    const auto file = labels(text);
    const auto begin = test::thread_seconds();
    for (std::size_t i = 0; i < files; ++i)
        ASSERT_EQ(file.find(fmt::format("raw/take{}/motion", i)), Rows{i});
    std::string deep;
    for (int i = 0; i < 500'000; ++i) deep += "a/";
    EXPECT_EQ(file.find(deep + "take7/motion.bvh"), Rows{7});
    EXPECT_LT(test::thread_seconds() - begin, 10);
}

TEST(LabelsFile, RefusesMoreColumnsThanADatasetHasFields) {
    std::string header = "file,action";
    for (int i = 2; i < 1000; ++i) header += fmt::format(",f{}", i);
    const std::string row = "\na,walk" + std::string(998, ',');
    EXPECT_EQ(labels(header + row + "\n").fields().size(), 999U);
    EXPECT_EQ(refusal(header + ",more" + row + ",\n"),
              "labels.csv: line 1: more than 1000 columns; leave out what no split asks for");
}

TEST(LabelsFile, RefusesWhatCannotBeMeant) {
    EXPECT_EQ(refusal(""), "labels.csv: empty; its first line names the columns, as in file,action");
    EXPECT_EQ(refusal("file,action\n"), "labels.csv: no row below the one that names the columns");
    EXPECT_EQ(refusal("file,style\na,b\n"),
              "labels.csv: line 1: no column called action, label or class; the first line names the "
              "columns, as in file,action,start_frame,end_frame");
    EXPECT_EQ(refusal("name,style\na,b\n"),
              "labels.csv: line 1: no column called action, label or class; the first line names the "
              "columns, as in name,action,start_frame,end_frame");
    EXPECT_EQ(refusal("label,style\na,b\n"),
              "labels.csv: line 1: no column called file, path, name or clip; the first line names the "
              "columns, as in file,label,start_frame,end_frame");
    EXPECT_EQ(refusal("file,action,file\na,b,c\n"), "labels.csv: line 1: two columns called 'file'");
    EXPECT_EQ(refusal("file,action,name\na,b,c\n"), "labels.csv: line 1: a field may not be called 'name'");
    EXPECT_EQ(refusal("file,action,my field\na,b,c\n"),
              "labels.csv: line 1: 'my field' is no field name of letters, digits, - and _");
    EXPECT_EQ(refusal("file,action\na,b\nc\n"),
              "labels.csv: line 3: 1 value, not 2 as the first line names columns");
    EXPECT_EQ(refusal("file,action,x\na,\"b\nb\",c\na,b\n"),
              "labels.csv: line 4: 2 values, not 3 as the first line names columns");
    EXPECT_EQ(refusal("file,action\n,b\n"), "labels.csv: line 2: no file; give every row both");
    EXPECT_EQ(refusal("file,action\na,\n"), "labels.csv: line 2: no action; give every row both");
    EXPECT_EQ(refusal("file,action\na,\"b\n"), "labels.csv: line 2: a \" without its closing \"");
    EXPECT_EQ(refusal("file,action\na,\"b\"c\n"), "labels.csv: line 2: text after the closing \" of 'b'");
    EXPECT_EQ(refusal("file,action,start\na,b,-1\n"),
              "labels.csv: line 2: '-1' is no frame; give a whole number from 0, or nothing");
    EXPECT_EQ(refusal("file,action,start,end\na,b,5,5\n"),
              "labels.csv: line 2: the end, frame 5, is not after the start, frame 5");
}

}  // namespace
}  // namespace actformer::ingest
