#include "ingest/formats/motions/csv_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"

using namespace actformer;
using namespace actformer::ingest;

namespace {

const std::vector<std::string> names{"hips", "left knee"};

CsvMotion read(std::string text) {
    const auto size = text.size();
    text.resize(size + 64, '\0');
    return read_csv_motion(std::string_view(text).substr(0, size), names);
}

std::string fault(const std::string& text) {
    try {
        read(text);
        return "taken";
    } catch (const Error& e) {
        return e.what();
    }
}

void expect_numbers(const CsvMotion& motion, const std::vector<double>& wanted) {
    ASSERT_EQ(motion.positions.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
        EXPECT_TRUE(motion.positions[i] == wanted[i] ||
                    (std::isnan(motion.positions[i]) && std::isnan(wanted[i])))
            << i;
}

const double not_there = std::nan("");

}  // namespace

TEST(CsvMotion, ReadsALineAFrame) {
    for (const std::string text :
         {"0,2,3,4,5,6\n7,8,9,10,11,12\n", "hx,hy,hz,kx,ky,kz\r\n0,2,3,4,5,6\r\n\r\n7,8,9,10,11,12",
          "0;2;3;4;5;6\n7;8;9;10;11;12",
          "\xEF\xBB\xBF"
          "0\t2\t3\t4\t5\t6\n7\t8\t9\t10\t11\t12",
          "  0 2  3 4 5 6 \n7 8 9 10 11 12\n"}) {
        const auto motion = read(text);
        EXPECT_EQ(motion.frames, 2U) << text;
        EXPECT_EQ(motion.persons, 1U);
        EXPECT_FALSE(motion.numbered_columns) << text;
        expect_numbers(motion, {0, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
    }
    expect_numbers(read("1,,nan,-4e-1,5,NaN\n"), {1, not_there, not_there, -0.4, 5, not_there});
}

TEST(CsvMotion, ALineThatNumbersTheColumnsIsNoFrame) {
    for (const std::string header :
         {"0,1,2,3,4,5\n", "1,2,3,4,5,6\r\n", "\"0\",\"1\",\"2\",\"3\",\"4\",\"5\"\n"}) {
        const auto motion = read(header + "0,1,2,3,4,5\n1,2,3,4,5,6\n");
        EXPECT_TRUE(motion.numbered_columns) << header;
        EXPECT_EQ(motion.frames, 2U) << header;
        expect_numbers(motion, {0, 1, 2, 3, 4, 5, 1, 2, 3, 4, 5, 6});
    }
    for (const std::string frame : {"0,1,2,3,4,6\n", "2,3,4,5,6,7\n", "0.0,1,2,3,4,5\n", ",0,1,2,3,4\n"})
        EXPECT_EQ(read(frame).frames, 1U) << frame;
    EXPECT_EQ(fault("0,1,2,3,4,5\n"), "line 1: no frame below the first line");
    EXPECT_EQ(fault("0,1,2,3,4\n").substr(0, 17), "line 1: 5 numbers");
}

TEST(CsvMotion, ReadsALineAJoint) {
    const auto motion = read(
        "score,joint,frame,x,y,z,person\n"
        "0.5,left knee,1,1,2,3,0\n"
        "0.5,0,0,4,5,6,1\n"
        "0.5,\"hips\",1,7,8,nan,1\n");
    EXPECT_EQ(motion.frames, 2U);
    EXPECT_EQ(motion.persons, 2U);
    expect_numbers(motion, {not_there, not_there, not_there, not_there, not_there, not_there,
                            4,         5,         6,         not_there, not_there, not_there,  //
                            not_there, not_there, not_there, 1,         2,         3,
                            7,         8,         not_there, not_there, not_there, not_there});
    EXPECT_EQ(read("frame,joint,x,y,z\n0,1,1,2,3\n").persons, 1U);
}

TEST(CsvMotion, NamesWhatIsWrong) {
    EXPECT_EQ(fault(""), "no line in it");
    EXPECT_EQ(fault("a,b,c,d,e,f\n"), "line 1: no frame below the first line");
    EXPECT_EQ(fault("1,2,3,4,5\n").substr(0, 48), "line 1: 5 numbers, not the 6 of 2 joints; or nam");
    EXPECT_EQ(fault("1,2,3,4,5,6\n1,2,3,4,5\n").substr(0, 17), "line 2: 5 numbers");
    EXPECT_EQ(fault("1,2,3,4,5,6\n1,2,3,x,5,6\n"), "line 2: 'x' where a coordinate should be");
    EXPECT_EQ(fault("1,2,3,4,5,1e999\n"), "line 1: '1e999' where a coordinate should be");
    EXPECT_EQ(fault("frame,joint,x,y\n0,1,1,2\n"), "line 1: no column called z");
    EXPECT_EQ(fault("frame,joint,x,y,z\n"), "line 1: no joint below the line that names the columns");
    EXPECT_EQ(fault("frame,joint,x,y,z\n0,1,1,2\n"),
              "line 2: 4 values, not 5 as the first line names columns");
    EXPECT_EQ(fault("frame,joint,x,y,z\n0,2,1,2,3\n"),
              "line 2: no joint '2'; there are hips, left knee and the numbers 0 to 1");
    EXPECT_EQ(fault("frame,joint,x,y,z\n-1,1,1,2,3\n"), "line 2: '-1' is no number of a frame, from 0");
    EXPECT_EQ(fault("frame,joint,x,y,z\n0,1,1,2,3\n0,left knee,1,2,3\n"),
              "joint 'left knee' of person 0 is there twice in frame 0");
    for (const auto* place : {"4000000000,0", "0,4000000000", "4294967295,4294967295"})
        EXPECT_NE(fault(fmt::format("frame,person,joint,x,y,z\n{},1,1,2,3\n", place)).find("numbered from 0"),
                  std::string::npos)
            << place;
}
