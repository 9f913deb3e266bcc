// Motions to draw, gathered from datasets and motions files in every representation.
#include "reports/motions/gather.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "tests/support/made_dataset.hpp"

using namespace actformer;
using namespace actformer::reports;
using namespace actformer::test;
using ingest::Representation;

namespace {

/// The joints of clip c1_4 are those of its closed form.
void expect_arms(const JointMotion& motion, Representation how) {
    const ArmsClip clip(1, 4, 40);
    ASSERT_EQ(motion.frames, 40U);
    EXPECT_EQ(motion.topology, ArmsClip::topology());
    // Limbs are shorter than 1 by 1e-4 over their length, twice down an arm; else float32's rounding.
    const double tolerance = how == Representation::limb ? 3e-4 : 3e-7;
    for (std::uint32_t t = 0; t < 40; ++t) {
        const auto wanted = clip.positions(t);
        for (std::size_t i = 0; i < wanted.size(); ++i)
            ASSERT_NEAR(motion.at(t, 0, i / 3)[i % 3], wanted[i], tolerance) << how.name() << ", frame " << t;
    }
}

/// c1_4 in a motions file, with or without what it takes to draw it.
std::filesystem::path motions_of(const TempDir& dir, Representation how, bool described) {
    const ingest::Dataset dataset(arms_in(how));
    ingest::MotionsWriter writer(dir / "m.h5");
    if (described) writer.describe(ingest::subjects_of(dataset));
    writer.add("A002_0", dataset.motion(dataset.find("c1_4").value()));
    writer.finish();
    return dir / "m.h5";
}

std::string error_of(const std::filesystem::path& path, const Wanted& wanted) {
    try {
        gather(path, wanted);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEST(Gather, DrawsTheSameJointsInEveryRepresentation) {
    for (const auto how : Representation::all()) {
        Wanted wanted;
        wanted.clips = {"c1_4"};
        expect_arms(gather(arms_in(how), wanted).at(0), how);

        const TempDir dir;
        expect_arms(gather(motions_of(dir, how, true), {}).at(0), how);
        Wanted from_dataset;
        from_dataset.bones = arms_in(how);
        expect_arms(gather(motions_of(dir, how, false), from_dataset).at(0), how);
    }
}

TEST(Gather, RefusesWhatItCannotTell) {
    const TempDir dir;
    const auto bare = motions_of(dir, Representation::rot6d, false);
    EXPECT_NE(error_of(bare, {}).find("8 nodes hang together; `export` and `render` take --bones"),
              std::string::npos)
        << error_of(bare, {});
    const auto limbs = motions_of(dir, Representation::limb, false);
    EXPECT_NE(error_of(limbs, {}).find("7 nodes hang together; `export` and `render` take --bones"),
              std::string::npos)
        << error_of(limbs, {});
    const auto rotations = motions_of(dir, Representation::rot6d, true);
    Wanted wanted;
    wanted.bones = arms_in(Representation::limb);
    EXPECT_NE(error_of(rotations, wanted).find("has motions in rot6d"), std::string::npos)
        << error_of(rotations, wanted);
}

TEST(Gather, TakesAsManyAsAskedForHoweverUnevenTheClasses) {
    const TempDir dir;
    const ingest::Dataset dataset(arms_in(Representation::xyz));
    ingest::MotionsWriter writer(dir / "m.h5");
    writer.describe(ingest::subjects_of(dataset));
    const auto motion = dataset.motion(0);
    for (const char* name : {"A001_0", "A002_0"}) writer.add(name, motion);
    for (int i = 0; i < 10; ++i) writer.add(fmt::format("A003_{}", i), motion);
    writer.finish();
    const auto labels = [&](const Wanted& wanted) {
        std::vector<int> counts(3, 0);
        for (const auto& one : gather(dir / "m.h5", wanted)) ++counts.at(one.label.value());
        return counts;
    };
    Wanted wanted;
    for (int count = 3; count <= 12; ++count) {
        wanted.count = static_cast<std::size_t>(count);
        EXPECT_EQ(labels(wanted), (std::vector<int>{1, 1, count - 2}));
    }
    wanted.count = 50;
    EXPECT_EQ(labels(wanted), (std::vector<int>{1, 1, 10}));
    wanted.per_class = 4;
    EXPECT_EQ(labels(wanted), (std::vector<int>{1, 1, 4}));
}
