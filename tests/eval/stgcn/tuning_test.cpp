#include "eval/stgcn/tuning.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include "tests/support/error_of.hpp"
#include "tests/support/replaced.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;

TEST(Tuning, KeepsTilesOfEveryDevice) {
    const test::TempDir cache;
    ::setenv("XDG_CACHE_HOME", cache.path().c_str(), 1);
    kernels::DeviceInfo one, other;
    one.type = other.type = "CPU";
    one.name = "one";
    other.name = "other";
    EXPECT_EQ(eval::load_tiles(one), default_tiles(one)) << "nothing kept yet";
    auto tiles = default_tiles(one);
    tiles.rows = 7;
    tiles.sequences = 3;
    eval::save_tiles(one, tiles);
    tiles.columns_first = true;
    eval::save_tiles(other, tiles);
    EXPECT_EQ(eval::load_tiles(other), tiles);
    tiles.columns_first = false;
    EXPECT_EQ(eval::load_tiles(one), tiles);
    one.driver = "newer";
    EXPECT_EQ(eval::load_tiles(one), default_tiles(one)) << "another driver is another device";

    // Other tiles round otherwise: features must not change in silence.
    const auto kept = test::read_file(eval::tiles_file());
    for (const auto& damaged : {std::string("{ damaged"), test::replaced(kept, "\"rows\": 7", "\"rows\": 5"),
                                test::replaced(kept, "\"checksum\"", "\"something\"")}) {
        test::write_file(eval::tiles_file(), damaged);
        const auto why = test::error_of([&] { eval::load_tiles(other); });
        EXPECT_NE(why.find("tiles.json: damaged; remove it"), std::string::npos) << why;
    }
    eval::save_tiles(other, tiles);
    EXPECT_EQ(eval::load_tiles(other), tiles) << "measured again";
    test::write_file(eval::tiles_file(), R"({"other |  | ": {"vec": 3, "rows": -1}})");
    EXPECT_EQ(eval::load_tiles(other), default_tiles(other));
    ::unsetenv("XDG_CACHE_HOME");
}
