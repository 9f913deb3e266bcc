// Files of motions: what they tell of themselves, and what is made of those that tell nothing.
#include "ingest/dataset/motions_file.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "base/checksum/own_checksum.hpp"
#include "base/error.hpp"
#include "base/hdf5/writer.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/described_motions.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/made_dataset.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::test;

namespace {

/// Two frames of one node, numbers 0 1 2 ..., with the attributes that `add` gives.
std::filesystem::path file_with(const TempDir& dir, std::uint64_t channels,
                                const std::function<void(hdf5::Writer&)>& add = {}) {
    const auto path = dir / "motions.h5";
    hdf5::Writer file(path);
    std::vector<float> values(channels * 2);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    file.write<float>("A001_0", {channels, 1, 2}, values);
    if (add) add(file);
    file.finish();
    return path;
}

}  // namespace

TEST(MotionsFile, TellsWhoseMotionsTheyAreInEveryRepresentation) {
    for (const auto how : Representation::all()) {
        const TempDir dir;
        const Dataset dataset(arms_in(how));
        const auto subjects = subjects_of(dataset);
        MotionsWriter writer(dir / "m.h5");
        writer.describe(subjects);
        writer.add("A003_0", dataset.motion(40));
        writer.finish();

        const MotionsFile file(dir / "m.h5");
        EXPECT_EQ(file.representation(), how);
        ASSERT_TRUE(file.subjects());
        EXPECT_EQ(*file.subjects(), subjects);
        const auto back = file.read("A003_0"), wanted = dataset.motion(40);
        EXPECT_EQ(back.values, wanted.values);
        EXPECT_EQ(back.nodes, wanted.nodes);
        EXPECT_EQ(back.numbers, wanted.numbers);
    }
}

TEST(MotionsFile, ReadsFilesThatTellNothingAsItIsTold) {
    const TempDir dir;
    const auto path = file_with(dir, 6);
    const auto limbs = MotionsFile(path).read("A001_0");
    EXPECT_EQ(limbs.persons, 2U);
    EXPECT_EQ(limbs.numbers, 3U);
    const auto rotations = MotionsFile(path, Representation::rot6d).read("A001_0");
    EXPECT_EQ(rotations.persons, 1U);
    EXPECT_EQ(rotations.values, (std::vector<float>{0, 2, 4, 6, 8, 10, 1, 3, 5, 7, 9, 11}));
    EXPECT_FALSE(MotionsFile(path).subjects());
}

TEST(MotionsFile, BelievesItsAttributeMoreThanItsCaller) {
    const TempDir dir;
    const auto path = file_with(dir, 6, [](auto& f) { f.attribute("representation", std::string("rot6d")); });
    EXPECT_EQ(MotionsFile(path).representation(), Representation::rot6d);
    EXPECT_EQ(MotionsFile(path).read("A001_0").persons, 1U);
}

TEST(MotionsFile, NoticesPositionsGivenAsLimbs) {
    for (const bool told : {false, true})
        for (const Representation how : {Representation::limb, Representation::xyz}) {
            const TempDir dir;
            MotionsWriter writer(dir / "m.h5");
            if (told) writer.note("representation", how.name());
            writer.add("A001_0", ArmsClip(0, 1, 30).in(how));
            writer.finish();
            const auto fault = error_of([&] { MotionsFile(dir / "m.h5").check_limbs(); });
            if (told || how == Representation::limb) {
                EXPECT_EQ(fault, "");
                continue;
            }
            EXPECT_NE(fault.find("'A001_0' holds no limb vectors"), std::string::npos) << fault;
            EXPECT_NE(
                fault.find("representation to xyz, or make a dataset of them with actformer ingest motions"),
                std::string::npos);
        }
}

TEST(MotionsFile, RefusesChannelsThatDoNotFit) {
    const TempDir dir;
    const auto nine = file_with(dir, 9, [](auto& f) { f.attribute("representation", std::string("rot6d")); });
    EXPECT_NE(error_of([&] {
                  MotionsFile(nine).read("A001_0");
              }).find("'A001_0' is no (P*6, K, T) array, as rot6d has them"),
              std::string::npos);
    const auto unknown =
        file_with(dir, 9, [](auto& f) { f.attribute("representation", std::string("euler")); });
    EXPECT_NE(error_of([&] { MotionsFile file(unknown); }).find("representation 'euler' is none of"),
              std::string::npos);
}

TEST(Subjects, NeedNoMoreThanParents) {
    const TempDir dir;
    const auto path = file_with(dir, 3, [](auto& f) {
        f.attribute("parents", std::vector<std::int64_t>{-1, 0});
    });
    const auto told = MotionsFile(path).subjects();
    ASSERT_TRUE(told);
    EXPECT_EQ(told->representation, Representation::limb);
    EXPECT_EQ(told->topology, (Topology{{"joint 0", "joint 1"}, {-1, 0}}));
    EXPECT_EQ(told->persons, 1U);
    EXPECT_EQ(told->fps, 30);
    EXPECT_TRUE(told->bone_length.empty());
}

TEST(Subjects, ReadTheNamesOfVersion01) {
    const TempDir dir;
    const auto path = file_with(dir, 3, [](auto& f) {
        f.attribute("parents", std::vector<std::int64_t>{-1, 0});
        f.attribute("joints", std::vector<std::string>{"hip", "head"});
        f.attribute("class_names", std::vector<std::string>{"walk"});
        f.attribute("bone_length", std::vector<float>{0, 0.5F, 0, 0.25F});
    });
    const auto told = MotionsFile(path).subjects();
    ASSERT_TRUE(told);
    EXPECT_EQ(told->topology.names, (std::vector<std::string>{"hip", "head"}));
    EXPECT_EQ(told->classes, std::vector<std::string>{"walk"});
    EXPECT_EQ(told->persons, 2U);
}

TEST(Subjects, RefuseAttributesThatContradictOneAnother) {
    const std::vector<std::int64_t> parents{-1, 0};
    for (const auto& wrong : std::vector<std::function<void(hdf5::Writer&)>>{
             [](auto& f) { f.attribute("names", std::vector<std::string>{"hip"}); },
             [](auto& f) {
                 f.attribute("bone_length", std::vector<float>{0, 0.5F, 0});
             },
             [](auto& f) {
                 f.attribute("bone_length", std::vector<float>{0, -1});
             },
             [](auto& f) { f.attribute("rest", std::vector<float>(6, 0.0F)); },
             [](auto& f) { f.attribute("representation", std::string("rot6d")); },
             [](auto& f) { f.attribute("fps", std::vector<float>{0}); },
             [](auto& f) { f.attribute("persons", std::int64_t{0}); }}) {
        const TempDir dir;
        const auto path = file_with(dir, 6, [&](auto& f) {
            f.attribute("parents", parents);
            wrong(f);
        });
        EXPECT_NE(error_of([&] { MotionsFile file(path); }).find("contradict one another"),
                  std::string::npos);
    }
}

TEST(PublicNames, AreRenumberedByTheLabel) {
    EXPECT_EQ(public_name("S001C001P001R001A106", 11), "S001C001P001R001A012");
    EXPECT_EQ(public_name("A003", 0), "A001");
    for (const char* kept : {"walk_active_001", "A003_7", "A03", "A0003", "B003", "003", ""})
        EXPECT_EQ(public_name(kept, 3), kept);
}

TEST(PublicNames, TellTheLabel) {
    for (const char* name : {"A012", "A012_7", "S001C001P001R001A012", "S001C001P001R001A012_body0",
                             "2b7e_l00_A012", "A003_A012", "A012_front", "A0012", "A012-1"})
        EXPECT_EQ(label_in(name), 11U) << name;
    EXPECT_EQ(label_in("A1000_0"), 999U);
    for (const char* name : {"A000", "A12", "walk_active_001", "A012x", "AA", "A99999999999", ""})
        EXPECT_EQ(label_in(name), std::nullopt) << name;
}

TEST(MotionsFile, RefusesALengthThatWrapsAround) {
    const TempDir dir;
    const auto path = dir / "motions.h5";
    hdf5::Writer file(path);
    file.write<float>("A001_0", {3, 2, 4241}, std::vector<float>(3 * 2 * 4241));
    file.finish();
    auto bytes = read_file(path);
    bytes.resize(bytes.size() - checksum_line({}).size());           // as another program writes it
    const std::uint64_t frames = 4241, wraps = 3074457345618258603;  // times 6 it is 2 modulo 2^64
    for (std::size_t at = 0; at + 8 <= bytes.size(); ++at)
        if (std::memcmp(&bytes[at], &frames, 8) == 0) std::memcpy(&bytes[at], &wraps, 8);
    write_file(path, bytes);
    const auto why = error_of([&] { MotionsFile(path).read("A001_0"); });
    EXPECT_NE(why.find("'A001_0'"), std::string::npos) << why;
    EXPECT_NE(why.find("damaged"), std::string::npos) << why;
}
