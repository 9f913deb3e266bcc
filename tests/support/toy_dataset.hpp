// Datasets small enough to train on in a test.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::test {

/// Class c swings its joint c, at a pace and phase that differ from clip to clip.
inline std::string toy_clip(int label, int index) {
    std::string text =
        "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Xrotation Yrotation "
        "Zrotation\n";
    for (int j = 0; j < 3; ++j)
        text += fmt::format(
            "JOINT J{}\n{{\nOFFSET 0 20 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nEnd Site\n{{\nOFFSET 0 "
            "5 0\n}}\nJOINT "
            "K{}\n{{\nOFFSET 5 9 0\nCHANNELS 1 Zrotation\n}}\n}}\n",
            j, j);
    text += "}\nMOTION\nFrames: 40\nFrame Time: 0.0333333\n";
    for (int t = 0; t < 40; ++t) {
        text += "0 90 0 0 0 0";
        for (int j = 0; j < 3; ++j)
            text +=
                fmt::format(" {:.3f} 0 0 0",
                            j == label ? 60 * std::sin((0.2 + 0.01 * (index % 5)) * t + index) : 2.0 * index);
        text += "\n";
    }
    return text;
}

/// A dataset of three classes, made once for all tests: 12 clips each in split s/train, 4 in s/test; class c2 is not in
/// split s/two, and split s/none is empty.
inline const std::filesystem::path& toy() {
    static const TempDir dir;
    static const std::filesystem::path out = [] {
        for (int label = 0; label < 3; ++label)
            for (int i = 0; i < 16; ++i)
                write_file(dir / fmt::format("raw/c{}_{}_{}.bvh", label, i < 12 ? "a" : "b", i),
                           toy_clip(label, i));
        const auto result =
            run_actformer("ingest bvh " + (dir / "raw").string() + " -o " + (dir / "toy").string() +
                          " --name '{action}_{part}_{index}' --split s/train=part:a --split s/test=part:b"
                          " --split s/two=action:c0,c1 --split s/none=part:z");
        EXPECT_EQ(result.exit, 0) << result.output;
        return dir / "toy";
    }();
    return out;
}

/// Two synthetic persons, 25 joints, a few clips of three of 26 classes; made once for all tests.
inline const std::filesystem::path& toy_pairs() {
    static const TempDir dir;
    static const std::filesystem::path out = [] {
        EXPECT_EQ(
            run_actformer("synth ntu -o " + (dir / "raw").string() + " --clips 12 --actions 50-52").exit, 0);
        EXPECT_EQ(
            run_actformer("ingest ntu " + (dir / "raw").string() + " -o " + (dir / "ntu").string()).exit, 0);
        return dir / "ntu/ntu-2p";
    }();
    return out;
}

}  // namespace actformer::test
