// Measures on disk, and files that hold others together.
#include "eval/scoring/measures_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/hdf5/writer.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::eval;
using namespace actformer::test;

namespace {

MotionMeasures of_two() {
    return {{1, 2}, {3, 4}, {5, 6}, {7, 8}, {9, 10, 11, 12, 13, 14}, 3};
}

TEST(MeasuresFile, ComesBackAsItWasWritten) {
    const TempDir dir;
    write_measures(dir / "two", of_two());
    const auto two = read_measures(dir / "two");
    EXPECT_EQ(two.limb_acceleration, of_two().limb_acceleration);
    EXPECT_EQ(two.root_acceleration, of_two().root_acceleration);
    EXPECT_EQ(two.root_speed, of_two().root_speed);
    EXPECT_EQ(two.foot_sliding, of_two().foot_sliding);
    EXPECT_EQ(two.distances, of_two().distances);
    EXPECT_EQ(two.columns, 3U);

    write_measures(dir / "none", {});
    EXPECT_EQ(read_measures(dir / "none").size(), 0U);
}

void expect_refused(const std::filesystem::path& file) {
    try {
        read_measures(file);
        ADD_FAILURE() << "taken";
    } catch (const actformer::Error& e) {
        const std::string why = e.what();
        EXPECT_NE(why.find("its arrays are not of the same motions; remove it"), std::string::npos) << why;
    }
}

TEST(MeasuresFile, IsRefusedWhereItsArraysAreOfOtherMotions) {
    const TempDir dir;
    for (const auto array :
         {&MotionMeasures::root_acceleration, &MotionMeasures::root_speed, &MotionMeasures::foot_sliding}) {
        auto measures = of_two();
        measures.*array = {1, 2, 3, 4};
        write_measures(dir / "other", measures);
        expect_refused(dir / "other");
    }
    actformer::hdf5::Writer distances(1000);
    distances.write<float>("distances", {3, 2}, std::vector<float>(6));
    actformer::write_whole(dir / "alone", distances.checked_image());
    expect_refused(dir / "alone");
}

}  // namespace
