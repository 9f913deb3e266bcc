// Exports of datasets and of motions files, in every representation, through the public face.
#include "ingest/export/export.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/error.hpp"
#include "base/numpy/npz.hpp"
#include "ingest/dataset/described_motions.hpp"
#include "ingest/export/export_format.hpp"
#include "ingest/export/rest_pose.hpp"
#include "ingest/export/rotations.hpp"
#include "ingest/export/skeletons.hpp"
#include "tests/support/glb.hpp"
#include "tests/support/made_dataset.hpp"
#include "tests/support/skeleton_motion.hpp"

namespace actformer::ingest {
namespace {

using namespace actformer::test;
namespace fs = std::filesystem;

std::string refusal(const ExportRequest& request) {
    try {
        export_clips(request);
    } catch (const Error& e) {
        return e.what();
    }
    return "taken";
}

ExportRequest request(const fs::path& input, const fs::path& out) {
    ExportRequest request;
    request.input = input;
    request.out = out;
    return request;
}

struct InEveryRepresentation : testing::TestWithParam<Representation::Kind> {
    Representation how = GetParam();
    fs::path dataset = arms_in(how);
    std::unique_ptr<ClipSource> source = open_clips(dataset);
    TempDir dir;

    /// Of clip `label`_`index` by the formulas it was made with.
    std::vector<Point> want(std::uint32_t label, std::uint32_t index) const {
        const ArmsClip clip(label, index, 40);
        std::vector<Point> out;
        for (std::uint32_t t = 0; t < 40; ++t) {
            const auto at = clip.positions(t);
            for (std::size_t j = 0; j < at.size(); j += 3) out.push_back({at[j], at[j + 1], at[j + 2]});
        }
        return out;
    }
};

// The numbers are float32, of less than 2 m: 1e-7 each, some of them along a chain.
constexpr double float32 = 1e-6;

// A joint may stay where the rest pose has it if it is rigid_within of it; three in a row add up.
constexpr double chain_slack = 3 * rigid_within;

TEST_P(InEveryRepresentation, JointsComeOut) {
    for (const std::size_t clip : {0U, 17U, 47U}) {
        const auto read = source->read(clip);
        EXPECT_LT(furthest(clip_joints(read), want(static_cast<std::uint32_t>(clip / 16), clip % 16)),
                  float32);
    }
}

// The arms keep their lengths and angles: rotations alone do.
TEST_P(InEveryRepresentation, SkeletonsTurnToTheJoints) {
    const auto pose = rest_pose(source->read(0));
    for (const std::size_t clip : {0U, 17U, 47U}) {
        const auto read = source->read(clip);
        const auto skeletons = skeletons_of(read, pose);
        ASSERT_EQ(skeletons.size(), 1U);
        EXPECT_LT(furthest(joints_of(skeletons[0]), clip_joints(read)), chain_slack);
        EXPECT_EQ(std::ranges::count(skeletons[0].slides, true), 1);
        for (std::size_t i = 7; i < skeletons[0].rotation.size(); ++i) {
            const auto &a = skeletons[0].rotation[i - 7], &b = skeletons[0].rotation[i];
            EXPECT_GE(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z, 0);
        }
    }
}

TEST_P(InEveryRepresentation, PublicLayoutComesBackToTheBit) {
    const auto summary = export_clips(request(dataset, dir / "all.h5"));
    EXPECT_EQ(summary.clips, 48U);
    EXPECT_EQ(summary.frames, 48U * 40);
    EXPECT_EQ(summary.representation, how.name());
    const auto back = open_clips(dir / "all.h5");
    EXPECT_EQ(back->subjects(), source->subjects());
    ASSERT_EQ(back->clips().size(), 48U);
    for (std::size_t i = 0; i < 48; ++i) {
        const auto read = back->read(i);
        const auto clip = source->read(static_cast<std::size_t>(
            std::ranges::find(source->clips(), read.name, &ClipEntry::name) - source->clips().begin()));
        EXPECT_EQ(read.motion.values, clip.motion.values);
        EXPECT_EQ(read.label, clip.label);
        EXPECT_EQ(read.body, clip.body);
    }
}

// What was exported once is exported again from there: the files are the same.
TEST_P(InEveryRepresentation, MotionsExportAsTheirDatasetDoes) {
    export_clips(request(dataset, dir / "all.h5"));
    for (const char* format : {"bvh", "glb"}) {
        auto one = request(dataset, dir / format);
        one.format = format;
        one.selection.label = "2";
        one.selection.count = 3;
        const auto first = export_clips(one);
        EXPECT_EQ(first.files.size(), 3U);
        auto other = one;
        other.input = dir / "all.h5";
        other.out = dir / "again";
        other.selection.count = 0;
        for (const auto& file : first.files) other.selection.clips.push_back(file.stem().string());
        const auto second = export_clips(other);
        ASSERT_EQ(second.files.size(), 3U);
        for (const auto& file : first.files)
            EXPECT_EQ(read_file(file), read_file(dir / "again" / file.filename())) << file;
    }
}

INSTANTIATE_TEST_SUITE_P(Export, InEveryRepresentation,
                         testing::Values(Representation::limb, Representation::rot6d, Representation::xyz),
                         [](const auto& kind) { return Representation(kind.param).name(); });

struct Exported : testing::Test {
    fs::path dataset = arms_in(Representation::limb);
    TempDir dir;

    /// Two persons, 25 joints as NTU has them, `frames` frames of noise; classes a to c unless `bare`.
    fs::path motions(const std::string& file, std::uint32_t frames = 6, bool bare = false) {
        MotionsWriter writer(dir / file);
        Subjects subjects;
        subjects.topology = ntu25();
        subjects.persons = 2;
        subjects.bone_length = usual_bone_lengths(ntu25());
        for (int i = 0; i < 25; ++i) subjects.bone_length.push_back(2 * subjects.bone_length[i]);
        subjects.classes = {"a", "b", "c"};
        subjects.fps = 25;
        if (!bare) writer.describe(subjects);
        std::mt19937 random(1);
        std::normal_distribution<float> normal;
        for (const char* name : {"A001_0", "A001_1", "A002_0", "A003_0"}) {
            Motion motion{name, frames, 2, 25, 3, std::vector<float>(frames * 150)};
            for (auto& v : motion.values) v = normal(random);
            for (std::size_t i = 0; i < motion.values.size(); i += 3) {
                const auto length = std::hypot(motion.values[i], motion.values[i + 1], motion.values[i + 2]);
                for (std::size_t d = 0; d < 3 && i / 3 % 25 > 0; ++d) motion.values[i + d] /= length;
            }
            writer.add(name, motion);
        }
        writer.finish();
        return dir / file;
    }
};

std::set<std::string> files_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
}

TEST_F(Exported, AFolderTakesAFileAClipAndBvhAFileAPerson) {
    auto wanted = request(motions("m.h5"), dir / "out");
    wanted.format = "bvh";
    wanted.selection.label = "a";
    const auto summary = export_clips(wanted);
    EXPECT_EQ(summary.clips, 2U);
    EXPECT_EQ(files_in(dir / "out"),
              (std::set<std::string>{"A001_0_p1.bvh", "A001_0_p2.bvh", "A001_1_p1.bvh", "A001_1_p2.bvh"}));
    EXPECT_EQ(summary.notes,
              (std::vector<std::string>{"20 joint names were changed, as 'left shoulder' to 'left_shoulder'",
                                        "files are named after their clips: `ingest bvh --name "
                                        "'A{action}_{index}_p{person}'` reads them back"}));
    wanted.format = "glb";
    export_clips(wanted);
    EXPECT_EQ(files_in(dir / "out").count("A001_0.glb"), 1U);
    EXPECT_NE(read_file(dir / "out/A001_0.glb").find("\"p2 left shoulder\""), std::string::npos);
}

TEST_F(Exported, OnePersonKeepsTheirBones) {
    auto wanted = request(motions("m.h5"), dir / "second.h5");
    wanted.selection.person = 2;
    wanted.selection.clips = {"A002_0"};
    export_clips(wanted);
    const auto whole = open_clips(dir / "m.h5"), alone = open_clips(dir / "second.h5");
    ASSERT_EQ(alone->clips().size(), 1U);
    EXPECT_EQ(alone->subjects().persons, 1U);
    const auto pair = clip_joints(whole->read(2)), one = clip_joints(alone->read(0));
    ASSERT_EQ(one.size(), 6U * 25);
    for (std::size_t t = 0; t < 6; ++t)
        for (std::size_t j = 0; j < 25; ++j) EXPECT_EQ(one[t * 25 + j], pair[(t * 2 + 1) * 25 + j]);
}

TEST_F(Exported, MotionsWithoutASkeletonGetNtusOrThatOfADataset) {
    const auto bare = open_clips(motions("bare.h5", 6, true));
    EXPECT_EQ(bare->subjects().topology, ntu25());
    EXPECT_EQ(bare->subjects().bone_length, usual_bone_lengths(ntu25()));
    EXPECT_EQ(bare->clips()[3].label, 2U);
    auto wanted = request(dir / "bare.h5", dir / "x.npz");
    wanted.bones = dataset;
    EXPECT_NE(refusal(wanted).find("motions of 25 nodes"), std::string::npos);
}

TEST_F(Exported, CountIsEvenlySpaced) {
    auto wanted = request(dataset, dir / "some");
    wanted.format = "npz";
    wanted.selection.count = 4;
    export_clips(wanted);
    EXPECT_EQ(files_in(dir / "some"),
              (std::set<std::string>{"c0_0.npz", "c0_12.npz", "c1_8.npz", "c2_4.npz"}));
}

TEST_F(Exported, LimbsOfNoLengthStayWithTheirParent) {
    MotionsWriter writer(dir / "still.h5");
    Motion motion{"A001_0", 2, 1, 25, 3, std::vector<float>(150)};
    for (std::size_t i = 1; i < 25; ++i) motion.values[i * 3 + 1] = 1;  // the second frame: all zeros
    writer.add("A001_0", motion);
    writer.finish();
    for (const char* format : {"bvh", "glb", "npz"}) {
        const auto out = dir / (std::string("still.") + format);
        ASSERT_EQ(refusal(request(dir / "still.h5", out)), "taken") << format;
    }
    const auto all_finite = [](const auto& numbers) {
        return !numbers.empty() && std::ranges::all_of(numbers, [](double v) { return std::isfinite(v); });
    };
    const auto bvh = read_file(dir / "still.bvh");
    const auto frames = bvh.find("MOTION");
    ASSERT_NE(frames, std::string::npos) << bvh;
    for (const char* no_number : {"nan", "inf"})
        EXPECT_EQ(bvh.find(no_number, frames), std::string::npos) << bvh.substr(frames);
    const auto glb = test::parsed(read_file(dir / "still.glb"));
    std::size_t arrays = 0;
    for (std::size_t i = 0; i < glb.json["accessors"].size(); ++i)
        if (glb.json["accessors"][i]["componentType"] == 5126) {
            EXPECT_TRUE(all_finite(glb.floats(i))) << "accessor " << i;
            ++arrays;
        }
    EXPECT_GT(arrays, 2U);  // times, rotations, and the root's places
    arrays = 0;
    read_npz(read_file(dir / "still.npz"), {}, [&](const std::string& name, const NumpyArray& array) {
        if (!array.numbers()) return;
        EXPECT_TRUE(all_finite(array.all_numbers())) << name;
        ++arrays;
    });
    EXPECT_EQ(arrays, 4U);  // the clip, labels, parents and fps
    const auto clip = open_clips(dir / "still.h5")->read(0);
    const auto skeletons = skeletons_of(clip, t_pose(ntu25()));
    EXPECT_LT(furthest(joints_of(skeletons[0]), clip_joints(clip)), 1e-9);
}

TEST_F(Exported, WhatCannotBeExportedIsSaid) {
    const auto file = motions("m.h5");
    const auto says = [&](const ExportRequest& wanted, const std::vector<std::string>& words) {
        const auto text = refusal(wanted);
        for (const auto& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << ": " << text;
        EXPECT_EQ(text.find('\n'), std::string::npos);
    };
    says(request(file, dir / "x.bhv"), {"x.bhv: ends in none of", "did you mean .bvh?"});
    says(request(file, dir / "x.fbx"), {"x.fbx: ends in none of .h5, .npz, .bvh, .glb", "--format"});
    says(request(file, dir / "x"), {"none of .h5"});
    says(request(file, dir.path()), {"--format", "h5, npz, bvh, glb"});
    says(request(dir / "none", dir / "x.h5"), {"none: no such file"});
    says(request(file, dir / "x.bvh"), {"holds one clip and 4 are chosen", "--clip", "--format bvh"});
    says(request(file, dir / "no/x.h5"), {"no folder"});
    auto wanted = request(file, dir / "x.npz");
    wanted.format = "fbx";
    says(wanted, {"'fbx'", "h5, npz, bvh, glb"});
    wanted.format = "bvh";
    says(wanted, {"ends in .npz, but --format says bvh"});
    wanted.format = "";
    wanted.selection.label = "d";
    says(wanted, {"no class 'd'", "1 to 3 ('a' .. 'c')"});
    wanted.selection.label = "0";
    says(wanted, {"no class 0"});
    wanted.selection.label = "4";
    says(wanted, {"no class 4"});
    wanted.selection.label = "";
    wanted.selection.clips = {"A009_0"};
    says(wanted, {"no clip 'A009_0'", "'A001_0'"});
    wanted.selection.clips = {"A002_0"};
    wanted.selection.label = "a";
    says(wanted, {"holds no clip of class 'a' among those named"});
    wanted.selection = {};
    wanted.selection.person = 3;
    says(wanted, {"has 2 persons, no number 3"});
    wanted.selection = {};
    wanted.selection.split = "xsub/train";
    says(wanted, {"has no splits"});
    wanted = request(dataset, dir / "x.h5");
    wanted.selection.split = "s/val";
    says(wanted, {"no split 's/val'", "s/train"});
    wanted.selection.split = "all";
    wanted.bones = dataset;
    says(wanted, {"leave --bones out"});
    EXPECT_EQ(files_in(dir.path()), std::set<std::string>{"m.h5"});
}

TEST_F(Exported, NumbersThatAreNotFiniteAreSaidAndNothingIsLeft) {
    MotionsWriter writer(dir / "nan.h5");
    for (const char* name : {"A001_0", "A001_1"}) {
        Motion motion{name, 3, 2, 25, 3, std::vector<float>(450, 0.6F)};
        if (name[5] == '1') motion.values[150 + 75 + 4 * 3 + 1] = std::numeric_limits<float>::quiet_NaN();
        writer.add(name, motion);
    }
    writer.finish();
    for (const char* out : {"x.h5", "x.npz"})
        EXPECT_NE(refusal(request(dir / "nan.h5", dir / out))
                      .find("clip A001_1 holds a number that is not finite (frame 2, person 2, node 5)"),
                  std::string::npos);
    EXPECT_EQ(files_in(dir.path()), std::set<std::string>{"nan.h5"});
}

TEST_F(Exported, ClipsThatThePublicLayoutWouldCallAlikeKeepTheirNames) {
    DatasetHeader header;
    header.name = "takes";
    header.topology = ArmsClip::topology();
    header.classes = {"walk", "run"};
    const auto written = [&](const std::vector<std::string>& names) {
        std::vector<MadeClip> clips;
        for (std::uint32_t i = 0; i < names.size(); ++i) {
            const ArmsClip clip(0, i, 4);
            clips.push_back({{"", 1, 0, 0, 0, {}}, clip.in(Representation::limb), clip.bone_length()});
            clips.back().motion.name = names[i];
        }
        write_dataset(dir / names[0], header, clips);
        const auto notes = export_clips(request(dir / names[0], dir / (names[0] + ".h5"))).notes;
        return std::pair(MotionsFile(dir / (names[0] + ".h5")).names(), notes);
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(written({"aA007", "bA008"}), std::pair(Names{"aA002", "bA002"}, Names{}));
    const auto [names, notes] = written({"takeA001", "takeA002", "z"});
    EXPECT_EQ(names, (Names{"takeA002", "take_2A002", "z"}));
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("as 'take_2A002' for 'takeA001'"), std::string::npos) << notes[0];
}

TEST_F(Exported, NamesThatNoFileMayHaveAreMadeFit) {
    MotionsWriter writer(dir / "names.h5");
    for (const char* name : {"..", "a:b", "a*b", "clips"})
        writer.add(name, {name, 1, 1, 25, 3, std::vector<float>(75, 0.6F)});
    writer.finish();
    auto wanted = request(dir / "names.h5", dir / "out");
    wanted.format = "bvh";
    const auto summary = export_clips(wanted);
    EXPECT_EQ(files_in(dir / "out"), (std::set<std::string>{"_..bvh", "a_b.bvh", "a_b_2.bvh", "clips.bvh"}));
    EXPECT_EQ(summary.notes[0], "3 file names were changed, as '..' to '_.'");
    const auto npz = export_clips(request(dir / "names.h5", dir / "names.npz"));
    EXPECT_EQ(npz.notes, std::vector<std::string>{"4 clip names were changed, as '..' to '_.'"});
}

}  // namespace
}  // namespace actformer::ingest
