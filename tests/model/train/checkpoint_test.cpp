// Checkpoints that were cut short, damaged or tampered with.
#include "model/train/checkpoint.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::model;
using namespace actformer::test;

namespace {

Checkpoint sample(std::uint64_t step) {
    return {step,
            {{"model", "toy"}, {"best", 0.25}},
            {{"a", {2, 2}, std::vector<float>{1, 2, 3, static_cast<float>(step)}},
             {"exact", {2}, std::vector<double>{1. / 3, -5e-300}},
             {"b", {}, std::vector<float>{5}}}};
}

void expect_same(Checkpoint a, Checkpoint b) {
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.state, b.state);
    ASSERT_EQ(a.arrays.size(), b.arrays.size());
    for (auto* checkpoint : {&a, &b}) std::ranges::sort(checkpoint->arrays, {}, &Array::name);
    for (std::size_t i = 0; i < a.arrays.size(); ++i) {
        EXPECT_EQ(a.arrays[i].name, b.arrays[i].name);
        EXPECT_EQ(a.arrays[i].shape, b.arrays[i].shape);
        EXPECT_EQ(a.arrays[i].values, b.arrays[i].values);
    }
}

const auto no_notes = [](const std::string& line) { ADD_FAILURE() << line; };

}  // namespace

TEST(Checkpoint, ComesBackWhole) {
    const TempDir dir;
    save_checkpoint(dir.path(), sample(3));
    const auto back = read_checkpoint(dir / "checkpoint-00003.h5");
    ASSERT_TRUE(back);
    expect_same(*back, sample(3));
}

TEST(Checkpoint, NeverComesBackInPart) {
    const TempDir dir;
    save_checkpoint(dir.path(), sample(3));
    const auto bytes = read_file(dir / "checkpoint-00003.h5");
    const auto comes_back = [&](const std::string& text) {
        write_file(dir / "other.h5", text);
        return read_checkpoint(dir / "other.h5").has_value();
    };
    ASSERT_TRUE(comes_back(bytes));
    for (std::size_t n = 0; n < bytes.size(); n += n < 64 || n + 64 > bytes.size() ? 1 : 7) {
        EXPECT_FALSE(comes_back(bytes.substr(0, n))) << n;
        auto damaged = bytes;
        damaged[n] = static_cast<char>(damaged[n] ^ 1);
        EXPECT_FALSE(comes_back(damaged)) << n;
    }
}

TEST(Checkpoint, IsNoOtherFileWithARightChecksum) {
    const TempDir dir;
    using Texts = std::vector<std::string>;
    const auto comes_back = [&](const Texts& progress, const std::vector<std::int64_t>& steps) {
        actformer::hdf5::Writer file(1000);
        if (!progress.empty()) file.write_strings("progress", progress);
        if (steps.size() == 1)
            file.attribute("step", steps[0]);
        else if (!steps.empty())
            file.attribute("step", steps);
        actformer::write_whole(dir / "other.h5", file.checked_image());
        return read_checkpoint(dir / "other.h5").has_value();
    };
    const std::string deep(100'000, '[');
    ASSERT_TRUE(comes_back({"{}"}, {3}));
    for (const Texts& progress : {Texts{}, {"{}", "{}"}, {"[1]"}, {"{"}, {""}, {deep}})
        EXPECT_FALSE(comes_back(progress, {3})) << (progress.empty() ? "none" : progress[0].substr(0, 9));
    for (const std::vector<std::int64_t>& steps : {std::vector<std::int64_t>{}, {-1}, {3, 4}})
        EXPECT_FALSE(comes_back({"{}"}, steps)) << steps.size();
}

TEST(Checkpoint, IsAFileThatHdf5Reads) {
    const TempDir dir;
    save_checkpoint(dir.path(), sample(3));
    const actformer::hdf5::Reader file(dir / "checkpoint-00003.h5");
    EXPECT_EQ(file.read<float>("a"), (std::vector<float>{1, 2, 3, 3}));
    EXPECT_EQ(file.read<double>("exact"), (std::vector<double>{1. / 3, -5e-300}));
    EXPECT_EQ(file.attribute_numbers("step"), std::vector<std::int64_t>{3});
}

TEST(Checkpoint, TheOneBeforeIsKeptAndUsed) {
    TempDir dir;
    std::vector<std::string> notes;
    const auto note = [&](const std::string& line) { notes.push_back(line); };
    EXPECT_FALSE(newest_checkpoint(dir.path(), "toy", note));
    std::filesystem::create_directories(dir / "checkpoint-200000.h5");
    std::filesystem::create_symlink("nowhere", dir / "checkpoint-200001.h5");
    EXPECT_FALSE(newest_checkpoint(dir.path(), "toy", note)) << "no files";
    for (const std::uint64_t step : {99998, 99999, 100000}) save_checkpoint(dir.path(), sample(step));
    EXPECT_FALSE(std::filesystem::exists(dir / "checkpoint-99998.h5"));
    expect_same(*newest_checkpoint(dir.path(), "toy", note), sample(100000));
    EXPECT_TRUE(notes.empty());

    std::filesystem::resize_file(dir / "checkpoint-100000.h5", 100);
    expect_same(*newest_checkpoint(dir.path(), "toy", note), sample(99999));
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("going back to the one before"), std::string::npos);

    write_file(dir / "checkpoint-99999.h5", "");
    EXPECT_FALSE(newest_checkpoint(dir.path(), "toy", note));
    ASSERT_EQ(notes.size(), 2U);
    EXPECT_NE(notes[1].find("starting anew"), std::string::npos);
}

TEST(Checkpoint, WhatCannotBeRemovedStays) {
    const TempDir dir;
    write_file(dir / "checkpoint-00001.h5/file", "a folder that is not empty");
    for (const std::uint64_t step : {2, 3, 4}) EXPECT_NO_THROW(save_checkpoint(dir.path(), sample(step)));
    EXPECT_TRUE(std::filesystem::exists(dir / "checkpoint-00001.h5/file"));
    EXPECT_FALSE(std::filesystem::exists(dir / "checkpoint-00002.h5"));
}

TEST(Checkpoint, DamagedOnesThatCannotBeSetAsideAreRefused) {
    const TempDir dir;
    write_file(dir / "checkpoint-00003.h5", "PK not one of ours");
    write_file(dir / "checkpoint-00003.h5.damaged/file", "a folder that is not empty");
    EXPECT_THROW(newest_checkpoint(dir.path(), "toy", [](const std::string&) {}), actformer::Error);
}

TEST(Checkpoint, DamagedOnesAreSetAsideAndForeignOnesRefused) {
    TempDir dir;
    write_file(dir / "checkpoint-00003.h5", "PK not one of ours");
    EXPECT_FALSE(newest_checkpoint(dir.path(), "toy", [](const std::string&) {}));
    EXPECT_EQ(read_file(dir / "checkpoint-00003.h5.damaged"), "PK not one of ours");

    save_checkpoint(dir.path(), sample(4));
    EXPECT_THROW(newest_checkpoint(dir.path(), "actformer", no_notes), actformer::Error);
    write_file(dir / "checkpoint-00005", "actformer checkpoint 2\nbefore it was HDF5");
    std::string note;
    expect_same(*newest_checkpoint(dir.path(), "toy", [&](const std::string& line) { note = line; }),
                sample(4));
    EXPECT_NE(note.find("checkpoint-00005: of another version; going back to"), std::string::npos) << note;
    std::filesystem::remove(dir / "checkpoint-00004.h5");
    try {
        newest_checkpoint(dir.path(), "toy", no_notes);
        ADD_FAILURE() << "taken";
    } catch (const actformer::Error& e) {
        EXPECT_NE(std::string(e.what()).find("checkpoint-00005: written by an earlier version"),
                  std::string::npos)
            << e.what();
    }
    EXPECT_TRUE(std::filesystem::exists(dir / "checkpoint-00005"));
}
