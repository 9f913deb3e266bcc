// JSON that may be anything.
#include "base/text/loose_json.hpp"

#include <gtest/gtest.h>

#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer {
namespace {

TEST(LooseJson, WhatIsNotThereOrNoJsonIsDiscarded) {
    const test::TempDir dir;
    test::write_file(dir / "list.json", "[1, 2]");
    test::write_file(dir / "cut.json", "[1, ");
    EXPECT_EQ(loose::read(dir / "list.json").dump(), "[1,2]");
    for (const auto* name : {"cut.json", "none.json", "."})
        EXPECT_TRUE(loose::read(dir / name).is_discarded()) << name;
}

TEST(LooseJson, FilesBeyondAnyOfItsKindAreNamedAndNotRead) {
    const test::TempDir dir;
    const auto path = dir / "large.json";
    test::write_file(path, "[]");
    std::filesystem::resize_file(path, (std::uintmax_t{256} << 20) + 1);  // a hole
    const auto why = test::error_of([&] { loose::read(path); });
    EXPECT_EQ(why.find(path.string() + ": 257 MiB, and a file of this kind has at most 256 MiB"), 0U) << why;
}

}  // namespace
}  // namespace actformer
