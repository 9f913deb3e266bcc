// Names made fit.
#include "ingest/export/fit_name.hpp"

#include <gtest/gtest.h>

#include "tests/support/thread_seconds.hpp"

namespace actformer::ingest {
namespace {

TEST(FitName, BvhTakesPrintableAsciiWithoutBlanksAndBraces) {
    EXPECT_EQ(fit_name("Hips", NameFor::bvh), "Hips");
    EXPECT_EQ(fit_name("left shoulder", NameFor::bvh), "left_shoulder");
    EXPECT_EQ(fit_name("a{b}\tc\n", NameFor::bvh), "a_b__c_");
    EXPECT_EQ(fit_name("\xE5\xB7\xA6 hip\xC3\xA9", NameFor::bvh), "__hip_");
    EXPECT_EQ(fit_name("\xFF\x80", NameFor::bvh), "__");
    EXPECT_EQ(fit_name("", NameFor::bvh), "_");
    EXPECT_EQ(fit_name("mixamorig:Hips", NameFor::bvh), "mixamorig:Hips");
}

TEST(FitName, FilesStayInTheirFolder) {
    EXPECT_EQ(fit_name("../../etc/passwd", NameFor::file), "_._.._etc_passwd");
    EXPECT_EQ(fit_name("..", NameFor::file), "_.");
    EXPECT_EQ(fit_name("a/b\\c:d", NameFor::file), "a_b_c_d");
    EXPECT_EQ(fit_name("p\xC3\xA4 x", NameFor::file), "p\xC3\xA4 x");
    const std::string long_name = std::string(199, 'a') + "\xC3\xA4" + "b";
    EXPECT_EQ(fit_name(long_name, NameFor::file), std::string(199, 'a'));
}

TEST(FitName, TextKeepsWhatIsPrintable) {
    EXPECT_EQ(fit_name("p\xC3\xA4/{x} y\x01", NameFor::text), "p\xC3\xA4/{x} y_");
}

TEST(FitNames, TellsThoseAlikeApart) {
    EXPECT_EQ(fit_names({"a b", "a_b", "a\tb", "c", "a_b_2"}, NameFor::bvh),
              (std::vector<std::string>{"a_b", "a_b_2", "a_b_3", "c", "a_b_2_2"}));
}

TEST(FitNames, TellsManyAlikeApartInNoTime) {
    const std::vector<std::string> names(100'000, "a b");
    const auto begin = test::thread_seconds();
    const auto fit = fit_names(names, NameFor::file);
    EXPECT_LT(test::thread_seconds() - begin, 10);
    EXPECT_EQ(fit.front(), "a b");
    EXPECT_EQ(fit.back(), "a b_100000");
}

TEST(NamesChanged, SaysHowManyAndWhichFirst) {
    EXPECT_EQ(names_changed({"a", "b"}, {"a", "b"}, "joint name"), "");
    EXPECT_EQ(names_changed({"a", "b c"}, {"a", "b_c"}, "joint name"),
              "1 joint name was changed, as 'b c' to 'b_c'");
    EXPECT_EQ(names_changed({"a b", "b c"}, {"a_b", "b_c"}, "joint name"),
              "2 joint names were changed, as 'a b' to 'a_b'");
}

}  // namespace
}  // namespace actformer::ingest
