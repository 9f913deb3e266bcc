#include "ingest/formats/ntu/name.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::ingest;
using actformer::test::TempDir;

TEST(NtuName, ReadsTheFiveNumbers) {
    const auto name = parse_ntu_name("S017C003P020R002A060");
    ASSERT_TRUE(name);
    EXPECT_EQ(name->setup, 17);
    EXPECT_EQ(name->camera, 3);
    EXPECT_EQ(name->performer, 20);
    EXPECT_EQ(name->replication, 2);
    EXPECT_EQ(name->action, 60);
}

TEST(NtuName, RefusesAllElse) {
    for (const char* name :
         {"", "S001C001P001R001A000", "S001C001P001R001A121", "s001c001p001r001a001", "S001C001P001R001A01",
          "S001C001P001R001A0011", "S001C001P001R0 1A001", "S001P001C001R001A001", "S-01C001P001R001A001"})
        EXPECT_FALSE(parse_ntu_name(name)) << name;
}

TEST(MissingList, ComesWithOrWithoutHeaderLinesAndInAnyLineEnds) {
    const TempDir dir;
    actformer::test::write_file(
        dir / "list",
        "\xEF\xBB\xBF"
        "Missing skeletons:\r\n\r\n  S001C002P005R002A008\r\nS001C002P006R001A008.skeleton\n"
        "S001C003P002R001A055");
    const auto names = read_missing_list(dir / "list");
    EXPECT_EQ(names.size(), 3U);
    EXPECT_TRUE(names.contains("S001C002P005R002A008"));
    EXPECT_TRUE(names.contains("S001C002P006R001A008"));
    EXPECT_TRUE(names.contains("S001C003P002R001A055"));
}

TEST(MissingList, WithoutANameIsRefused) {
    const TempDir dir;
    actformer::test::write_file(dir / "list", "nothing here\n");
    EXPECT_THROW(read_missing_list(dir / "list"), actformer::Error);
    EXPECT_THROW(read_missing_list(dir / "absent"), actformer::Error);
}
