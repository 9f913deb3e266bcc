// Checkpoints that were cut short, damaged or tampered with.
#include "model/train/checkpoint.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::model;
using namespace actformer::test;

namespace {

Checkpoint sample(std::uint64_t done) {
    return {done,
            {{"model", "toy"}, {"best", 0.25}},
            {{"a", {2, 2}, std::vector<float>{1, 2, 3, static_cast<float>(done)}},
             {"exact", {2}, std::vector<double>{1. / 3, -5e-300}},
             {"b", {}, std::vector<float>{5}}}};
}

void expect_same(const Checkpoint& a, const Checkpoint& b) {
    EXPECT_EQ(a.done, b.done);
    EXPECT_EQ(a.state, b.state);
    ASSERT_EQ(a.arrays.size(), b.arrays.size());
    for (std::size_t i = 0; i < a.arrays.size(); ++i) {
        EXPECT_EQ(a.arrays[i].name, b.arrays[i].name);
        EXPECT_EQ(a.arrays[i].shape, b.arrays[i].shape);
        EXPECT_EQ(a.arrays[i].values, b.arrays[i].values);
    }
}

}  // namespace

TEST(Checkpoint, ComesBackWhole) {
    const auto back = checkpoint_from(to_bytes(sample(3)));
    ASSERT_TRUE(back);
    expect_same(*back, sample(3));
}

TEST(Checkpoint, NeverComesBackInPart) {
    const auto bytes = to_bytes(sample(3));
    for (std::size_t n = 0; n < bytes.size(); ++n) {
        EXPECT_FALSE(checkpoint_from(bytes.substr(0, n))) << n;
        auto damaged = bytes;
        damaged[n] = static_cast<char>(damaged[n] ^ 1);
        EXPECT_FALSE(checkpoint_from(damaged)) << n;
    }
}

TEST(Checkpoint, TheOneBeforeIsKeptAndUsed) {
    TempDir dir;
    std::vector<std::string> notes;
    const auto note = [&](const std::string& line) { notes.push_back(line); };
    EXPECT_FALSE(newest_checkpoint(dir.path(), "toy", note));
    for (const std::uint64_t done : {99998, 99999, 100000}) save_checkpoint(dir.path(), sample(done));
    EXPECT_FALSE(std::filesystem::exists(dir / "checkpoint-99998"));
    expect_same(*newest_checkpoint(dir.path(), "toy", note), sample(100000));
    EXPECT_TRUE(notes.empty());

    std::filesystem::resize_file(dir / "checkpoint-100000", 100);
    expect_same(*newest_checkpoint(dir.path(), "toy", note), sample(99999));
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("going back to the one before"), std::string::npos);

    write_file(dir / "checkpoint-99999", "");
    EXPECT_FALSE(newest_checkpoint(dir.path(), "toy", note));
    ASSERT_EQ(notes.size(), 2U);
    EXPECT_NE(notes[1].find("starting anew"), std::string::npos);
}

TEST(Checkpoint, DamagedOnesAreSetAsideAndForeignOnesRefused) {
    TempDir dir;
    const auto note = [](const std::string&) {};
    write_file(dir / "checkpoint-00003", "PK not one of ours");
    EXPECT_FALSE(newest_checkpoint(dir.path(), "toy", note));
    EXPECT_EQ(read_file(dir / "checkpoint-00003.damaged"), "PK not one of ours");

    save_checkpoint(dir.path(), sample(4));
    EXPECT_THROW(newest_checkpoint(dir.path(), "generator", note), actformer::Error);
    write_file(dir / "checkpoint-00005", "actformer checkpoint 9\nwhat versions to come may write");
    EXPECT_THROW(newest_checkpoint(dir.path(), "toy", note), actformer::Error);
    EXPECT_TRUE(std::filesystem::exists(dir / "checkpoint-00005"));
}
