// What export writes comes back through `ingest motions`, and what users give wrongly is one line.
#include <gtest/gtest.h>

#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/arrays.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/toy_dataset.hpp"
#include "tests/support/tree.hpp"

using namespace actformer;
using namespace actformer::test;

namespace {

std::string in(const TempDir& dir, const std::string& name) {
    return (dir / name).string();
}

}  // namespace

TEST(IngestMotions, TakesBackWhatExportWritesToTheBit) {
    const TempDir dir;
    ASSERT_EQ(
        run_actformer("synth ntu -o " + in(dir, "raw") + " --clips 8 --actions 50-53,106 --seed 3").exit, 0);
    ASSERT_EQ(run_actformer("ingest ntu " + in(dir, "raw") + " -o " + in(dir, "ntu")).exit, 0);
    ASSERT_EQ(run_actformer("export " + in(dir, "ntu/ntu-2p") + " -o " + in(dir, "out.h5")).exit, 0);
    const auto back = run_actformer("ingest motions " + in(dir, "out.h5") + " -o " + in(dir, "back"));
    ASSERT_EQ(back.exit, 0) << back.output;
    const ingest::Dataset before(dir / "ntu/ntu-2p"), after(dir / "back");
    EXPECT_EQ(after.header().topology, before.header().topology);
    EXPECT_EQ(after.header().classes, before.header().classes);
    EXPECT_EQ(after.header().persons, 2U);
    EXPECT_EQ(after.header().fps, before.header().fps);
    ASSERT_EQ(after.clips().size(), before.clips().size());
    for (std::size_t i = 0; i < before.clips().size(); ++i) {
        const auto& clip = before.clips()[i];
        const auto found = after.find(ingest::public_name(clip.name, clip.label));
        ASSERT_TRUE(found) << clip.name;
        EXPECT_EQ(after.clips()[*found].label, clip.label);
        EXPECT_EQ(after.motion(*found).values, before.motion(i).values) << clip.name;
    }
    EXPECT_EQ(run_actformer("inspect --verify " + in(dir, "back")).exit, 0);
}

TEST(IngestMotions, ItsOutputMayLieAmongItsRawData) {
    const TempDir dir;
    std::filesystem::create_directories(dir / "raw");
    ASSERT_EQ(run_actformer("export " + toy().string() + " -o " + in(dir, "raw/m.h5")).exit, 0);
    const auto command = "ingest motions " + in(dir, "raw") + " -o " + in(dir, "raw/out");
    ASSERT_EQ(run_actformer(command).exit, 0);
    const auto made = tree(dir / "raw/out");
    const auto again = run_actformer(command);
    EXPECT_EQ(again.exit, 0);
    EXPECT_NE(again.output.find("complete already"), std::string::npos) << again.output;
    EXPECT_EQ(tree(dir / "raw/out"), made);
}

TEST(IngestMotions, ReadsAnArrayAsItsHelpSays) {
    const TempDir dir;
    std::string values;
    for (int i = 0; i < 2 * 3 * 3 * 3; ++i) {
        const float x = static_cast<float>(i % 7) / 4;
        values.append(reinterpret_cast<const char*>(&x), sizeof x);
    }
    write_file(dir / "joints.npy", npy("<f4", "(2, 3, 3, 3)", values));
    write_file(dir / "skeleton.json", R"({"names": ["a", "b", "c"], "parents": [-1, 0, 1]})");
    write_file(dir / "labels.csv", "name,label,subject\njoints_0,walk,s1\njoints_1,run,s2\n");
    const auto command = "ingest motions " + in(dir, "joints.npy") + " --topology " +
                         in(dir, "skeleton.json") + " --labels " + in(dir, "labels.csv") +
                         " --split test=subject:s2 --axes ntkc --json -o ";
    const auto result = run_actformer(command + in(dir, "out"));
    ASSERT_EQ(result.exit, 0) << result.output;
    const ingest::Dataset dataset(dir / "out");
    EXPECT_EQ(dataset.header().classes, (std::vector<std::string>{"run", "walk"}));
    EXPECT_EQ(dataset.split("test"), std::vector<std::size_t>{1});
    EXPECT_EQ(dataset.clips()[0].frames, 3U);

    // Settings with names of classes and joints are longer than an attribute of HDF5; either's names fit into one.
    const auto write_named = [&](std::size_t size) {
        const std::string name(size, 'a');
        write_file(dir / "labels.csv",
                   "name,label,subject\njoints_0," + name + ",s1\njoints_1,b" + name + ",s2\n");
        return std::vector<std::string>{name, "b" + name};
    };
    write_file(dir / "skeleton.json",
               R"({"names": ["a", "b", ")" + std::string(20'000, 'c') + R"("], "parents": [-1, 0, 1]})");
    const auto names = write_named(30'000);
    ASSERT_EQ(run_actformer(command + in(dir, "long")).exit, 0);
    EXPECT_EQ(ingest::Dataset(dir / "long").header().classes, names);
    write_named(40'000);
    expect_refused(run_actformer(command + in(dir, "wrong")), {"2 classes", "would take 80002 bytes"});

    const auto plain = "ingest motions " + in(dir, "joints.npy") + " -o " + in(dir, "wrong");
    expect_refused(run_actformer(plain), {"no motion in any file", "give --topology"});
    expect_refused(run_actformer(plain + " --topology smpl24"),
                   {"(2, 3, 3, 3) is no array of 24 joints", "--axes"});
    expect_refused(run_actformer(plain + " --topology smpl23"), {"no topology 'smpl23'", "smpl24"});
    EXPECT_FALSE(std::filesystem::exists(dir / "wrong"));
}
