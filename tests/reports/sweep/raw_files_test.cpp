#include "reports/sweep/raw_files.hpp"

#include <gtest/gtest.h>

#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::reports;
using namespace actformer::test;
namespace fs = std::filesystem;

TEST(RawFiles, AreTheSameUntilOneIsThereMoreOrChanges) {
    const TempDir dir;
    const auto raw = dir / "raw", out = raw / "out";
    fs::create_directories(raw / "deep");
    write_file(raw / "deep/a.bvh", "a walk");
    fs::create_directory_symlink("..", raw / "deep/circle");
    const auto at_first = listing_of(raw, out);
    EXPECT_EQ(listing_of(raw, out), at_first);
    fs::create_directory(out);
    write_file(out / "b.bvh", "the sweep's own");
    EXPECT_EQ(listing_of(raw, out), at_first) << "its own files are none of them";
    EXPECT_NE(listing_of(raw, dir / "elsewhere"), at_first);
    for (const auto* name : {".nfs01", "notes.txt~", "data/dataset.json", "data/shard-00000.h5"}) {
        fs::create_directories((raw / name).parent_path());
        write_file(raw / name, "none of an ingest's");
    }
    EXPECT_EQ(listing_of(raw, out), at_first);
    write_file(raw / "b.bvh", "a run");
    const auto with_another = listing_of(raw, out);
    EXPECT_NE(with_another, at_first);
    fs::last_write_time(raw / "b.bvh", fs::file_time_type::clock::now() + std::chrono::hours(1));
    EXPECT_NE(listing_of(raw, out), with_another);
    EXPECT_NE(listing_of(raw / "b.bvh", out), listing_of(raw / "deep/a.bvh", out));
}
