// Arrays and files in the public layout, through the pipeline to a dataset.
#include "ingest/formats/motions/motions_format.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <random>
#include <set>

#include "base/error.hpp"
#include "base/hdf5/writer.hpp"
#include "ingest/pipeline/pipeline.hpp"
#include "tests/support/arrays.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t joint_count = 3;
using Names = std::vector<std::string>;

struct MotionsOnDevice : testing::Test {
    MotionsOnDevice() {
        write_file(dir / "skeleton.yaml", "names: [hips, knee, foot]\nparents: [-1, 0, 1]\n");
        options.dataset = "made";
        options.topology = (dir / "skeleton.yaml").string();
    }

    IngestSummary run(const char* out = "out") {
        IngestRequest request;
        request.raw = raw;
        request.out = dir / out;
        request.one_dataset = true;
        request.threads = 2;
        MotionsFormat format(options);
        return ingest::ingest(request, format, device);
    }

    Dataset made(const char* out = "out") const { return Dataset(dir / out); }

    std::string fault() {
        try {
            run("fault");
            return "taken";
        } catch (const Error& e) {
            return e.what();
        }
    }

    /// Numbers of a .npy file below raw/.
    std::vector<double> add_npy(const std::string& name, const std::vector<std::uint64_t>& shape,
                                unsigned seed = 1) {
        std::uint64_t count = 1;
        for (const auto n : shape) count *= n;
        std::vector<double> values(count);
        std::mt19937 random(seed);
        for (auto& x : values) x = std::uniform_real_distribution<double>(-1, 1)(random);
        write_npy(name, shape, values);
        return values;
    }

    void write_npy(const std::string& name, const std::vector<std::uint64_t>& shape,
                   const std::vector<double>& values) {
        std::string bytes(values.size() * sizeof(double), '\0');
        std::memcpy(bytes.data(), values.data(), bytes.size());
        write_file(
            dir / "raw" / name,
            npy("<f8", fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : ""), bytes));
    }

    /// Clips (persons * numbers, nodes, frames) of a file in the public layout; the numbers are those of `seed`.
    std::vector<float> add_public(const std::string& file, const Names& clips,
                                  const std::vector<std::uint64_t>& shape,
                                  const std::function<void(hdf5::Writer&)>& tell = {}) {
        std::vector<float> values(shape[0] * shape[1] * shape[2]);
        std::mt19937 random(7);
        for (auto& x : values) x = std::uniform_real_distribution<float>(-1, 1)(random);
        fs::create_directories(dir / "raw");
        hdf5::Writer out(dir / "raw" / file);
        for (const auto& clip : clips) out.write<float>(clip, {shape[0], shape[1], shape[2]}, values);
        if (tell) tell(out);
        out.finish();
        return values;
    }

    TempDir dir;
    std::vector<fs::path> raw{dir / "raw"};
    kernels::Device device;
    MotionsOptions options;
};

/// Attributes of motions of rotations: three joints of these names, each a place in its parent.
std::function<void(hdf5::Writer&)> rotations(const Names& names, const std::vector<float>& rest) {
    return [=](hdf5::Writer& file) {
        file.attribute("representation", std::string("rot6d"));
        file.attribute("parents", std::vector<std::int64_t>{-1, 0, 1});
        file.attribute("names", names);
        file.attribute("rest", rest);
    };
}

/// (frames, joints, 3) positions of a leg that stands with its hips `height` over the floor, `up` being axis 0, 1 or 2.
std::vector<double> standing(std::size_t frames, double height, std::size_t up) {
    std::vector<double> out;
    for (std::size_t t = 0; t < frames; ++t)
        for (std::size_t j = 0; j < joint_count; ++j) {
            std::array<double, 3> at{0.1 * height, 0.1 * height, 0.1 * height};
            at[up] = height * static_cast<double>(joint_count - 1 - j) / (joint_count - 1);
            at[(up + 1) % 3] += 0.001 * height * static_cast<double>(t * j);
            out.insert(out.end(), at.begin(), at.end());
        }
    return out;
}

Names doubts_of(const IngestSummary& summary) {
    Names out;
    for (const auto& doubt : summary.doubts) out.push_back(doubt.what);
    std::sort(out.begin(), out.end());
    return out;
}

/// A clip's names and labels, as in "walk_1:walk".
Names clips_of(const Dataset& dataset) {
    Names out;
    for (const auto& clip : dataset.clips())
        out.push_back(clip.name + ":" + dataset.header().classes[clip.label]);
    return out;
}

/// What limbs and root a clip of `frames` x `persons` bodies at `positions` has.
std::vector<double> limbs_of(const double* positions, std::size_t frames, std::size_t persons) {
    double mean[3] = {};
    const auto bodies = frames * persons;
    for (std::size_t b = 0; b < bodies; ++b)
        for (std::size_t d = 0; d < 3; ++d)
            mean[d] += positions[b * joint_count * 3 + d] / static_cast<double>(bodies);
    std::vector<double> out;
    for (std::size_t b = 0; b < bodies; ++b) {
        const double* body = positions + b * joint_count * 3;
        for (std::size_t d = 0; d < 3; ++d) out.push_back(body[d] - mean[d]);
        for (std::size_t j = 1; j < joint_count; ++j) {
            const double x = body[3 * j] - body[3 * j - 3], y = body[3 * j + 1] - body[3 * j - 2],
                         z = body[3 * j + 2] - body[3 * j - 1],
                         length = std::sqrt(x * x + y * y + z * z) + 1e-4;
            out.insert(out.end(), {x / length, y / length, z / length});
        }
    }
    return out;
}

// float32 of numbers about 1: 1e-7 each, and the device's square root and division some units more.
void expect_near(const std::vector<float>& got, const std::vector<double>& want) {
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < got.size(); ++i) ASSERT_NEAR(got[i], want[i], 2e-6) << i;
}

}  // namespace

TEST_F(MotionsOnDevice, PositionsBecomeLimbs) {
    const auto values = add_npy("takes/walk_1.npy", {20, joint_count, 3});
    const auto two = add_npy("both.npy", {10, joint_count, 3}, 2);
    options.fps = 25;
    const auto summary = run();
    const auto dataset = made();
    EXPECT_EQ(clips_of(dataset), (Names{"both:motion", "walk_1:motion"}));
    EXPECT_EQ(dataset.header().fps, 25);
    EXPECT_EQ(dataset.header().topology.names, (Names{"hips", "knee", "foot"}));
    expect_near(dataset.motion(0).values, limbs_of(two.data(), 10, 1));
    expect_near(dataset.motion(1).values, limbs_of(values.data(), 20, 1));
    double length = 0;
    for (std::size_t t = 0; t < 20; ++t) {
        const double* body = &values[t * joint_count * 3];
        length += std::hypot(body[3] - body[0], body[4] - body[1], body[5] - body[2]) / 20;
    }
    EXPECT_NEAR(dataset.bone_length(1)[1], length, 1e-6);
    EXPECT_EQ(summary.left_out.size(), 0U);
    EXPECT_TRUE(verify_dataset(dir / "out").faults.empty());
}

TEST_F(MotionsOnDevice, ManyClipsOfAnArrayHaveTheirLabels) {
    const auto values = add_npy("all.npy", {4, 6, 2, joint_count, 3});
    write_file(
        dir / "labels.tsv",
        "name\tlabel\tsubject\nall_0\twalk\ts1\nall_1\tjump, high\ts2\nall_3\twalk\ts2\nall_9\twalk\ts1\n");
    options.labels = (dir / "labels.tsv").string();
    options.splits = {{"test", {{"subject", {"s2"}, false}}}};
    const auto summary = run();
    const auto dataset = made();
    EXPECT_EQ(clips_of(dataset), (Names{"all_0:walk", "all_1:jump, high", "all_3:walk"}));
    EXPECT_EQ(dataset.split("test"), (std::vector<std::size_t>{1, 2}));
    EXPECT_EQ(dataset.header().persons, 2U);
    expect_near(dataset.motion(2).values, limbs_of(&values[3 * 6 * 2 * joint_count * 3], 6, 2));
    EXPECT_EQ(summary.left_out, (std::map<std::string, std::uint64_t>{{"dropped", 1}}));
    EXPECT_NE(read_file(dir / "out/rejected.csv").find("all.npy,dropped,clip 2: no row of"),
              std::string::npos);
    ASSERT_EQ(summary.remarks.size(), 1U);
    EXPECT_NE(summary.remarks[0].find("1 of 4 rows are for files that are not there: all_9"),
              std::string::npos)
        << summary.remarks[0];
}

TEST_F(MotionsOnDevice, LabelsThatEndBehindAMotionAreCutOffThereAndSaySo) {
    add_npy("a.npy", {6, joint_count, 3});
    add_public("b.h5", {"A001_0"}, {3, joint_count, 4});
    write_file(dir / "labels.csv",
               "file,action,start_frame,end_frame\na,walk,0,6\na,run,2,7\nA001_0,walk,0,4\nA001_0,run,1,5\n");
    options.labels = (dir / "labels.csv").string();
    const auto summary = run();
    const auto dataset = made();
    EXPECT_EQ(dataset.clips()[*dataset.find("a_2-7")].frames, 4U);
    EXPECT_EQ(dataset.clips()[*dataset.find("A001_0_1-5")].frames, 3U);
    const auto doubt = std::find_if(summary.doubts.begin(), summary.doubts.end(), [](const auto& one) {
        return one.what == "the label ends behind the motion: cut off there";
    });
    ASSERT_NE(doubt, summary.doubts.end());
    EXPECT_EQ(doubt->first, (Names{"a_2-7", "A001_0_1-5"}));
}

TEST_F(MotionsOnDevice, FoldersAndNamesTellTheAction) {
    for (const char* name : {"walk/1.npy", "walk/2.npy", "run/1.npy"}) add_npy(name, {5, joint_count, 3});
    options.pattern = "{action}/{index}";
    run();
    EXPECT_EQ(clips_of(made()), (Names{"run_1:run", "walk_1:walk", "walk_2:walk"}));
    options.pattern = "";
    run("untold");
    EXPECT_EQ(clips_of(made("untold")), (Names{"run_1:motion", "walk_1:motion", "walk_2:motion"}));
}

TEST_F(MotionsOnDevice, TheFoldersOfClassesMayBeGivenThemselves) {
    for (const char* name : {"walk/1.npy", "walk/2.npy", "run/1.npy"}) add_npy(name, {5, joint_count, 3});
    raw = {dir / "raw/walk", dir / "raw/run"};
    options.pattern = "{action}/{index}";
    run();
    EXPECT_EQ(clips_of(made()), (Names{"walk_1:walk", "walk_2:walk", "run_1:run"}));
    options.pattern = "";
    run("untold");
    EXPECT_EQ(clips_of(made("untold")), (Names{"walk_1:motion", "walk_2:motion", "run_1:motion"}));
    write_file(dir / "labels.csv", "name,label\nwalk/1,slow\nrun/1,fast\n");
    options.labels = (dir / "labels.csv").string();
    run("labelled");
    EXPECT_EQ(clips_of(made("labelled")), (Names{"walk_1:slow", "run_1:fast"}));
}

TEST_F(MotionsOnDevice, PathsInAnArchiveBeginAtItsTop) {
    for (const char* name : {"walk/1.npy", "run/1.npy", "1.npy"}) add_npy(name, {5, joint_count, 3});
    const auto archive = dir / "takes.tar";
    ASSERT_EQ(run_command("tar -C " + raw[0].string() + " -cf " + archive.string() + " run walk 1.npy").exit,
              0);
    raw = {archive};
    options.pattern = "{action}/{index}";
    run();
    EXPECT_EQ(clips_of(made()), (Names{"run_1:run", "walk_1:walk"}));
    EXPECT_NE(read_file(dir / "out/rejected.csv").find("1.npy,broken,the name does not fit the pattern"),
              std::string::npos)
        << read_file(dir / "out/rejected.csv");
}

TEST_F(MotionsOnDevice, ThePublicLayoutIsStoredToTheBit) {
    const auto values = add_public("a.h5", {"A002_1", "A001_0", "dance"}, {6, joint_count, 5});
    const auto summary = run();
    const auto dataset = made();
    EXPECT_EQ(clips_of(dataset), (Names{"A001_0:A001", "A002_1:A002", "dance:motion"}));
    EXPECT_EQ(dataset.header().persons, 2U);
    EXPECT_EQ(dataset.header().representation, Representation::limb);
    const auto motion = dataset.motion(1);
    for (std::size_t p = 0; p < 2; ++p)
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t k = 0; k < joint_count; ++k)
                for (std::size_t t = 0; t < 5; ++t)
                    ASSERT_EQ(motion.at(t, p, k)[c], values[((p * 3 + c) * joint_count + k) * 5 + t]);
    ASSERT_EQ(summary.doubts.size(), 1U);
    EXPECT_EQ(summary.doubts[0].clips, 3U) << "random numbers are no unit limbs";
    ASSERT_EQ(summary.remarks.size(), 1U);
    EXPECT_NE(summary.remarks[0].find("usual lengths"), std::string::npos);
}

TEST_F(MotionsOnDevice, AFileThatTellsNeedsNoTopology) {
    add_public("a.h5", {"A001_0", "A003_0"}, {3, joint_count, 4}, [](hdf5::Writer& file) {
        file.attribute("parents", std::vector<std::int64_t>{-1, 0, 1});
        file.attribute("names", Names{"a", "b", "c"});
        file.attribute("classes", Names{"walk", "run", "sit"});
        file.attribute("fps", std::vector<float>{12});
        file.attribute("bone_length", std::vector<float>{0, 0.5F, 0.25F});
    });
    options.topology.clear();
    run();
    const auto dataset = made();
    EXPECT_EQ(clips_of(dataset), (Names{"A001_0:walk", "A003_0:sit"}));
    EXPECT_EQ(dataset.header().classes, (Names{"walk", "run", "sit"})) << "told, with or without clips";
    EXPECT_EQ(dataset.header().fps, 12);
    EXPECT_EQ(dataset.header().topology, (Topology{{"a", "b", "c"}, {-1, 0, 1}}));
    EXPECT_EQ(dataset.bone_length(0), (std::vector<float>{0, 0.5F, 0.25F}));
}

TEST_F(MotionsOnDevice, RotationsAreToldByTheirNodes) {
    add_public("a.h5", {"A001_0"}, {6, joint_count + 1, 4});
    EXPECT_NE(fault().find("no rest pose"), std::string::npos) << fault();
    fs::remove(dir / "raw/a.h5");
    add_public("b.h5", {"A001_0"}, {6, 25, 4});
    options.topology = "smpl24";
    const auto summary = run();
    const auto motion = made().motion(0);
    EXPECT_EQ(made().header().representation, Representation::rot6d);
    EXPECT_EQ(motion.nodes, 25U);
    EXPECT_EQ(motion.numbers, 6U);
    EXPECT_FLOAT_EQ(made().bone_length(0)[4], 0.404F) << "the left shin of a mean body";
    ASSERT_EQ(summary.remarks.size(), 1U);
    EXPECT_NE(summary.remarks[0].find("that of a mean body is taken"), std::string::npos);
    add_npy("c.npy", {5, 24, 3});
    run("mixed");
    EXPECT_NE(
        read_file(dir / "mixed/rejected.csv").find("c.npy,dropped,\"joint positions, and not rotations"),
        std::string::npos);
}

TEST_F(MotionsOnDevice, RotationsOfAnotherRestSkeletonAreLeftOut) {
    const Names names{"hips", "knee", "foot"};
    const std::vector<float> rest{0, 0.9F, 0, 0.05F, -0.45F, 0, 0, -0.4F, 0.1F};
    auto longer = rest, rounded = rest;
    for (auto& x : longer) x *= 1.5F;
    for (auto& x : rounded) x *= 1.00001F;
    const auto add = [this](const std::string& file, const std::string& clip, const auto& tell) {
        add_public(file, {clip}, {6, joint_count + 1, 4}, tell);
    };
    add("a.h5", "A001_0", rotations(names, rest));
    add("b.h5", "A001_1", rotations(names, longer));
    add("c.h5", "A001_2", rotations(names, rounded));
    add("d.h5", "A001_3", rotations({"hips", "foot", "knee"}, rest));
    options.topology.clear();
    run();
    EXPECT_EQ(clips_of(made()), (Names{"A001_0:A001", "A001_2:A001"}));
    EXPECT_EQ(made().header().rest, rest);
    const auto rejected = read_file(dir / "out/rejected.csv");
    EXPECT_NE(
        rejected.find("its rest skeleton is not that of the first file: offsets differ by up to 0.45 m"),
        std::string::npos)
        << rejected;
    EXPECT_NE(rejected.find("its joint 1 is 'foot', and 'knee' in the first file; --topology takes"),
              std::string::npos)
        << rejected;
    options.topology = (dir / "skeleton.yaml").string();
    run("by_order");
    EXPECT_EQ(clips_of(made("by_order")), (Names{"A001_0:A001", "A001_2:A001", "A001_3:A001"}));
}

TEST_F(MotionsOnDevice, WhatFitsBothLayoutsIsToldByItsLimbs) {
    const auto random = add_public("a.h5", {"only"}, {6, joint_count, 3});
    run("positions");
    EXPECT_EQ(made("positions").motion(0).frames, 6U);
    expect_near(made("positions").motion(0).values,
                limbs_of(std::vector<double>(random.begin(), random.end()).data(), 6, 1));
    fs::remove(dir / "raw/a.h5");
    std::vector<float> limbs(3 * joint_count * 3);  // (3, joints, frames): each along one axis
    for (std::size_t k = 0; k < joint_count; ++k)
        for (std::size_t t = 0; t < 3; ++t) limbs[((k + t) % 3 * joint_count + k) * 3 + t] = 1;
    add_public("b.h5", {"long"}, {3, joint_count, 5}, [&](hdf5::Writer& file) {
        file.write<float>("three", {3, joint_count, 3}, limbs);
    });
    run("limbs");
    const auto motion = made("limbs").motion(*made("limbs").find("three"));
    for (std::size_t k = 0; k < joint_count; ++k)
        for (std::size_t t = 0; t < 3; ++t)
            for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(motion.at(t, 0, k)[c], (k + t) % 3 == c ? 1 : 0);
}

TEST_F(MotionsOnDevice, OtherUnitsAndAnotherAxisUpAreSaid) {
    for (const char* name : {"a.npy", "b.npy"}) write_npy(name, {40, joint_count, 3}, standing(40, 900, 2));
    const auto summary = run();
    EXPECT_EQ(
        doubts_of(summary),
        (Names{"bodies point from the root to the head along z: where they do not lie, --up z turns them "
               "upright",
               "bodies taller than 4 m at --scale 1: --scale 0.001 would make them about as tall as "
               "a person"}));
    EXPECT_EQ(summary.doubts[0].clips, 2U);
    options.scale = 0.001;
    options.up = "-z";
    EXPECT_EQ(doubts_of(run("on_heads")),
              Names{"bodies stand on their heads: where they should not, --up z turns them upright"});
    options.up = "z";
    EXPECT_EQ(doubts_of(run("mended")), Names{});
    options.representation = "xyz";
    EXPECT_EQ(doubts_of(run("xyz")), Names{});
    options.scale = 0.00001;
    EXPECT_EQ(doubts_of(run("tiny")),
              Names{"bodies smaller than 0.1 m at --scale 1e-05: --scale 0.001 would make them about as "
                    "tall as a person"});
}

TEST_F(MotionsOnDevice, TheAxisThatIsUpIsTheArrays) {
    write_npy("a.npy", {40, joint_count, 3}, standing(40, 0.9, 1));
    EXPECT_EQ(doubts_of(run("right")), Names{});
    options.up = "z";
    EXPECT_EQ(
        doubts_of(run("wrong")),
        Names{"bodies point from the root to the head along y: where they do not lie, --up y turns them "
              "upright"});
    write_file(dir / "skeleton.yaml", "names: [a, b, c]\nparents: [-1, 0, 1]\n");
    EXPECT_EQ(
        doubts_of(run("untold")),
        Names{"bodies are longest along y: where they do not lie, --up y or --up -y turns them upright"});
}

TEST_F(MotionsOnDevice, StoredMotionsThatLieAreSaidToo) {
    std::vector<float> limbs(3 * joint_count * 5);
    std::fill(&limbs[2 * joint_count * 5 + 5], limbs.data() + limbs.size(), -1.0F);  // z of knee and foot
    fs::create_directories(dir / "raw");
    hdf5::Writer file(dir / "raw/a.h5");
    file.write<float>("A001_0", {3, joint_count, 5}, limbs);
    file.finish();
    EXPECT_EQ(doubts_of(run()),
              Names{"bodies point from the root to the head along z: where they do not lie, turn the file's "
                    "motions so that y is up; --up is for joint positions alone"});
}

TEST_F(MotionsOnDevice, FirstLinesThatNumberTheColumnsAreSaid) {
    for (const char* name : {"a", "b"})
        write_file(dir / "raw" / (std::string(name) + ".csv"),
                   "0,1,2,3,4,5,6,7,8\n0,0.9,0,0,0.5,0,0,0,0\n0,0.9,0,0,0.5,0,0,0,0.1\n");
    write_file(dir / "raw/c.csv", "0,0.9,0,0,0.5,0,0,0,0\n0,0.9,0,0,0.5,0,0,0,0.1\n");
    const auto summary = run();
    EXPECT_EQ(made().motion(0).frames, 2U);
    ASSERT_EQ(summary.remarks.size(), 1U);
    EXPECT_EQ(
        summary.remarks[0],
        fmt::format("line 1 numbers the columns of 2 files ({0}/a.csv, {0}/b.csv) and is no frame; where it "
                    "is one, put a line of names before it",
                    (dir / "raw").string()));
}

TEST_F(MotionsOnDevice, StoredLimbsAndPositionsShareADataset) {
    add_public("b.h5", {"A001_0"}, {3, joint_count, 4});
    const auto first = add_npy("a.npy", {5, joint_count, 3}), last = add_npy("c.npy", {6, joint_count, 3}, 3);
    run();
    const auto dataset = made();
    EXPECT_EQ(clips_of(dataset), (Names{"a:motion", "A001_0:A001", "c:motion"}));
    expect_near(dataset.motion(0).values, limbs_of(first.data(), 5, 1));
    expect_near(dataset.motion(2).values, limbs_of(last.data(), 6, 1));
    EXPECT_EQ(dataset.motion(1).frames, 4U);
    EXPECT_GT(dataset.bone_length(2)[2], 0);
}

TEST_F(MotionsOnDevice, PositionsMayStay) {
    const auto values = add_npy("a.npy", {7, joint_count, 3});
    options.representation = "xyz";
    run();
    const auto dataset = made();
    EXPECT_EQ(dataset.header().representation, Representation::xyz);
    std::vector<double> want = values;
    double mean[3] = {};
    for (std::size_t t = 0; t < 7; ++t)
        for (std::size_t d = 0; d < 3; ++d) mean[d] += values[t * joint_count * 3 + d] / 7;
    for (std::size_t i = 0; i < want.size(); ++i) want[i] -= mean[i % 3];
    expect_near(dataset.motion(0).values, want);
}

TEST_F(MotionsOnDevice, PositionsOfThePublicLayoutTellTheirLengths) {
    const auto xyz = [](hdf5::Writer& file) { file.attribute("representation", std::string("xyz")); };
    const auto values = add_public("a.h5", {"dance"}, {6, joint_count, 5}, xyz);
    run();
    const auto lengths = made().bone_length(0);
    ASSERT_EQ(lengths.size(), 2 * joint_count);
    for (std::size_t p = 0; p < 2; ++p) {
        EXPECT_EQ(lengths[p * joint_count], 0);
        for (std::size_t j = 1; j < joint_count; ++j) {
            double mean = 0;
            for (std::size_t t = 0; t < 5; ++t) {
                const auto along = [&](std::size_t d) {
                    const auto* joint = &values[((p * 3 + d) * joint_count + j) * 5 + t];
                    return double{joint[0]} - joint[-5];  // each joint hangs on the one before it
                };
                mean += std::hypot(along(0), along(1), along(2)) / 5;
            }
            EXPECT_NEAR(lengths[p * joint_count + j], mean, 1e-6);
        }
    }
}

TEST_F(MotionsOnDevice, WhyNoClipIsLeftIsSaid) {
    add_public("a.h5", {"dance"}, {3, joint_count, 5},
               [](hdf5::Writer& file) { file.attribute("representation", std::string("xyz")); });
    options.scale = 0.001;
    EXPECT_EQ(fault(),
              fmt::format("{0}: none of 1 file gave a clip; the first: {0}/a.h5: 'dance': positions in the "
                          "public layout stay as they are: no --clean, --scale or --up for them",
                          (dir / "raw").string()));
}

TEST_F(MotionsOnDevice, CleaningSmooths) {
    const std::size_t frames = 40;
    const auto values = add_npy("a.npy", {frames, joint_count, 3});
    // A Gaussian of 3 frames over 12 either way, edges mirrored with the edge sample repeated.
    std::vector<double> smooth(values.size(), 0);
    double sum = 0;
    for (int i = -12; i <= 12; ++i) sum += std::exp(-i * i / 18.0);
    for (int t = 0; t < static_cast<int>(frames); ++t)
        for (int i = -12; i <= 12; ++i) {
            int at = t + i;
            if (at < 0) at = -at - 1;
            if (at >= static_cast<int>(frames)) at = 2 * static_cast<int>(frames) - 1 - at;
            for (std::size_t k = 0; k < joint_count * 3; ++k)
                smooth[static_cast<std::size_t>(t) * joint_count * 3 + k] +=
                    std::exp(-i * i / 18.0) / sum *
                    values[static_cast<std::size_t>(at) * joint_count * 3 + k];
        }
    options.clean = true;
    run();
    // Smoothed limbs are short, which makes their directions ten times as sensitive.
    const auto got = made().motion(0).values;
    const auto want = limbs_of(smooth.data(), frames, 1);
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], want[i], 2e-5) << i;
    options.representation = "xyz";
    run("xyz");
    const auto positions = made("xyz").motion(0).values;
    for (std::size_t t = 0; t < frames; ++t)
        for (std::size_t d = 0; d < 3; ++d)
            EXPECT_NEAR(positions[t * joint_count * 3 + 3 + d] - positions[t * joint_count * 3 + d],
                        smooth[t * joint_count * 3 + 3 + d] - smooth[t * joint_count * 3 + d], 2e-6);
}

TEST_F(MotionsOnDevice, WhatIsWrongIsNamedAndTheRestTaken) {
    auto values = add_npy("sound.npy", {5, joint_count, 3}, 2);  // bodies that turn this way and that
    add_npy("other.npy", {5, joint_count + 1, 3});
    write_npy("unseen.npy", {5, joint_count, 3}, std::vector<double>(5 * joint_count * 3, std::nan("")));
    write_file(dir / "raw/cut.npy", read_file(dir / "raw/sound.npy").substr(0, 300));
    write_file(dir / "raw/page.npz", "<html>quota exceeded</html>");
    write_file(dir / "raw/words.csv", "a,b\nc,d\n");
    write_file(dir / "raw/no.h5", "no HDF5");
    values[4] = std::nan("");
    write_npy("gaps.npy", {5, joint_count, 3}, values);
    const auto summary = run();
    EXPECT_EQ(clips_of(made()), (Names{"gaps:motion", "sound:motion"}));
    EXPECT_EQ(summary.left_out, (std::map<std::string, std::uint64_t>{{"broken", 6}}));
    const auto csv = read_file(dir / "out/rejected.csv");
    for (const char* words : {"other.npy,broken,\"(5, 4, 3) is no array of 3 joints",
                              "unseen.npy,broken,no number in it: nobody is seen",
                              "cut.npy,broken,\"(5, 3, 3) <f8 numbers do not fit", "page.npz,broken,",
                              "words.csv,broken,", "no.h5,broken,"})
        EXPECT_NE(csv.find(words), std::string::npos) << words << "\n" << csv;
    ASSERT_EQ(summary.doubts.size(), 1U);
    EXPECT_EQ(summary.doubts[0].first, Names{"gaps"});
}

TEST_F(MotionsOnDevice, ClassesThatNoWeightsWouldHoldAreRefused) {
    add_npy("a.npy", {5, joint_count, 3});
    std::string labels = "file,action\n";
    for (int i = 0; i < 400; ++i)
        labels += fmt::format("a,{}{}\n", i, i == 7 ? std::string(200, 'x') : std::string());
    write_file(dir / "labels.csv", labels);
    options.labels = (dir / "labels.csv").string();
    EXPECT_NE(
        fault().find("400 classes, each stored at the length of the longest name, would take 80400 bytes"),
        std::string::npos)
        << fault();
}

TEST_F(MotionsOnDevice, WhatMakesNoDatasetIsOneLine) {
    add_npy("a.npy", {5, joint_count + 1, 3});
    EXPECT_EQ(fault().substr(0, 44), "no motion in any file; the first fault is in");
    options.topology.clear();
    EXPECT_NE(fault().find("it does not tell its skeleton; give --topology"), std::string::npos) << fault();
    const auto refused = [this](auto change) {
        auto changed = options;
        change(changed);
        try {
            MotionsFormat format(changed);
            return std::string("taken");
        } catch (const Error& e) {
            return std::string(e.what());
        }
    };
    EXPECT_NE(refused([](auto& o) { o.scale = 0; }), "taken");
    EXPECT_NE(refused([](auto& o) { o.fps = -1; }), "taken");
    EXPECT_NE(refused([](auto& o) { o.up = "w"; }), "taken");
    EXPECT_NE(refused([](auto& o) { o.axes = "abc"; }), "taken");
    EXPECT_NE(refused([](auto& o) { o.topology = "ntu26"; }), "taken");
    EXPECT_NE(refused([](auto& o) { o.representation = "rot6d"; }), "taken");
}

TEST_F(MotionsOnDevice, NpzTellsAllOfItself) {
    if (!python_has("numpy")) GTEST_SKIP() << "NumPy is not at hand";
    const auto made_it =
        run_command("mkdir -p " + (dir / "raw").string() + " && cd " + (dir / "raw").string() +
                    " && /usr/bin/python3 -c \"import numpy as np\n"
                    "a = np.random.default_rng(0).normal(size=(9, 1, 3, 3)).astype('f4')\n"
                    "np.savez('all.npz', x=a, y=a[:4], clips=np.array(['x', 'y']), labels=np.array([1, 0]),\n"
                    "  classes=np.array(['sit', 'walk']), names=np.array(['a', 'b', 'c']),\n"
                    "  parents=np.array([-1, 0, 1]), fps=np.float64(50))\"");
    ASSERT_EQ(made_it.exit, 0) << made_it.output;
    options.topology.clear();
    run();
    const auto dataset = made();
    EXPECT_EQ(clips_of(dataset), (Names{"x:walk", "y:sit"}));
    EXPECT_EQ(dataset.header().fps, 50);
    EXPECT_EQ(dataset.header().topology.names, (Names{"a", "b", "c"}));
    EXPECT_EQ(dataset.clips()[1].frames, 4U);
}

TEST_F(MotionsOnDevice, EveryOptionShowsInTheSettings) {
    add_npy("a_1.npy", {5, joint_count, 3});
    write_file(dir / "labels.csv", "name,label\na_1,x\n");
    const auto settings = [this](auto change) {
        auto changed = options;
        change(changed);
        MotionsFormat format(changed);
        const auto bytes = read_file(dir / "raw/a_1.npy");
        format.survey({"a_1.npy", "a_1", bytes, "a_1.npy", 0});
        format.settle();
        return format.settings();
    };
    std::vector<std::string> all{settings([](auto&) {})};
    all.push_back(settings([](auto& o) { o.scale = 0.5; }));
    all.push_back(settings([](auto& o) { o.up = "z"; }));
    all.push_back(settings([](auto& o) { o.fps = 12; }));
    all.push_back(settings([](auto& o) { o.persons = 2; }));
    all.push_back(settings([](auto& o) { o.axes = "tkc"; }));
    all.push_back(settings([](auto& o) { o.clean = true; }));
    all.push_back(settings([](auto& o) { o.centre_windows = true; }));
    all.push_back(settings([](auto& o) { o.representation = "xyz"; }));
    all.push_back(settings([](auto& o) { o.pattern = "{action}_{i}"; }));
    all.push_back(settings([this](auto& o) { o.labels = (dir / "labels.csv").string(); }));
    all.push_back(settings([](auto& o) { o.splits = {{"s", {{"action", {"motion"}, false}}}}; }));
    EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), all.size());
}
