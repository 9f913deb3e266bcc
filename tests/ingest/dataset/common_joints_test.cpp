// One body seen as the 15 common joints, whatever skeleton and representation tell it.
#include "ingest/dataset/common_joints.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "base/error.hpp"
#include "ingest/dataset/known_topologies.hpp"

using namespace actformer;
using namespace actformer::ingest;

namespace {

constexpr std::uint32_t frames = 5, persons = 2;

/// What the joints of common15() are called elsewhere.
const std::map<std::string, std::map<std::string, std::string>> names{
    {"ntu25", {{"neck", "chest"}}}, {"smpl24", {}}, {"gta22", {{"head", "head center"}}}, {"common15", {}}};

using Point = std::array<float, 3>;

/// Where a joint of that name is: two persons of random build who jump about.
Point place(const std::string& joint, std::uint32_t frame, std::uint32_t person) {
    std::mt19937 random(static_cast<unsigned>(std::hash<std::string>{}(joint)) + 31 * person);
    std::uniform_real_distribution<float> any(-1, 1);
    Point at{any(random), any(random), any(random)};
    at[0] += 0.1F * static_cast<float>(frame) + 2 * static_cast<float>(person);
    at[1] += joint == "left knee" ? 0.05F * static_cast<float>(frame * frame) : 0;
    return at;
}

std::string name_elsewhere(const std::string& skeleton, const std::string& joint) {
    const auto& other = names.at(skeleton);
    const auto found = other.find(joint);
    return found == other.end() ? joint : found->second;
}

/// The two persons as positions of a skeleton's joints; joints that no other skeleton has lie anywhere.
Motion positions(const std::string& skeleton, const Topology& topology, double size = 1, double away = 0) {
    std::map<std::string, std::string> common;
    for (const auto& joint : common15().names) common[name_elsewhere(skeleton, joint)] = joint;
    Motion motion{"jump", frames, persons, static_cast<std::uint32_t>(topology.joints()), 3, {}};
    for (std::uint32_t t = 0; t < frames; ++t)
        for (std::uint32_t p = 0; p < persons; ++p)
            for (const auto& name : topology.names) {
                const auto found = common.find(name);
                for (const auto x : place(found == common.end() ? skeleton + name : found->second, t, p))
                    motion.values.push_back(static_cast<float>(size * x + away));
            }
    return motion;
}

BodyModel body(Representation how, const Topology& topology) {
    return {how, topology, {}, {}};
}

void expect_near(const Motion& a, const Motion& b, double tolerance) {
    ASSERT_EQ(a.values.size(), b.values.size());
    for (std::size_t i = 0; i < a.values.size(); ++i)
        ASSERT_NEAR(a.values[i], b.values[i], tolerance) << "number " << i;
}

double length(const float* x) {
    return std::hypot(x[0], x[1], x[2]);
}

}  // namespace

TEST(CommonJoints, AreTheSameOfEverySkeleton) {
    const auto expected =
        CommonJoints(body(Representation::xyz, common15()), "").of(positions("common15", common15()));
    const std::set<std::string> without{"coco17", "h36m17"};  // whose joints are others
    for (const auto& [name, topology] : known_topologies()) {
        if (without.contains(std::string(name))) continue;
        const CommonJoints common(body(Representation::xyz, topology), "");
        expect_near(common.of(positions(std::string(name), topology)), expected, 0);
    }
}

TEST(CommonJoints, AreUnitLimbsAndRootsInTheMeasureOfTheLegs) {
    const auto motion = positions("ntu25", ntu25());
    const auto seen = CommonJoints(body(Representation::xyz, ntu25()), "").of(motion);
    ASSERT_EQ(seen.nodes, 15U);
    double centre[3] = {0, 0, 0};
    for (std::uint32_t t = 0; t < frames; ++t)
        for (std::uint32_t p = 0; p < persons; ++p)
            for (int d = 0; d < 3; ++d) centre[d] += place("pelvis", t, p)[d] / (frames * persons);
    for (std::uint32_t p = 0; p < persons; ++p) {
        double leg = 0;
        for (std::uint32_t t = 0; t < frames; ++t)
            for (const std::string side : {"left ", "right "}) {
                const auto hip = place(side + "hip", t, p), knee = place(side + "knee", t, p),
                           ankle = place(side + "ankle", t, p);
                leg += (std::hypot(knee[0] - hip[0], knee[1] - hip[1], knee[2] - hip[2]) +
                        std::hypot(ankle[0] - knee[0], ankle[1] - knee[1], ankle[2] - knee[2])) /
                       (2 * frames);
            }
        for (std::uint32_t t = 0; t < frames; ++t) {
            for (int d = 0; d < 3; ++d)
                EXPECT_NEAR(seen.at(t, p, 0)[d], (place("pelvis", t, p)[d] - centre[d]) * 0.75 / leg, 1e-6);
            const auto elbow = place("left elbow", t, p), wrist = place("left wrist", t, p);
            const Point forearm{wrist[0] - elbow[0], wrist[1] - elbow[1], wrist[2] - elbow[2]};
            for (int d = 0; d < 3; ++d)
                EXPECT_NEAR(seen.at(t, p, 5)[d], forearm[d] / (length(forearm.data()) + 1e-4), 1e-6);
        }
    }
}

TEST(CommonJoints, DoNotDependOnSizeAndPlace) {
    const CommonJoints common(body(Representation::xyz, gta22()), "");
    const auto once = common.of(positions("gta22", gta22()));
    // limbs are divided by their length and 0.1 mm, which is more of a small body than of a large one
    expect_near(common.of(positions("gta22", gta22(), 3, 0)), once, 3e-3);
    expect_near(common.of(positions("gta22", gta22(), 1, 50)), once, 1e-4);
}

TEST(CommonJoints, OfLimbsNeedTheirLengths) {
    const auto places = positions("smpl24", smpl24());
    Motion limbs = places;
    std::vector<float> lengths(persons * 24, 0);
    for (std::uint32_t t = 0; t < frames; ++t)  // the first frame's body throughout: limbs do not stretch
        for (std::uint32_t p = 0; p < persons; ++p)
            for (std::uint32_t j = 1; j < 24; ++j) {
                const auto parent = static_cast<std::uint32_t>(smpl24().parents[j]);
                auto* limb = &limbs.values[((t * persons + p) * 24 + j) * 3];
                for (int d = 0; d < 3; ++d) limb[d] = places.at(0, p, j)[d] - places.at(0, p, parent)[d];
                const auto n = length(limb);
                for (int d = 0; d < 3; ++d) limb[d] = static_cast<float>(limb[d] / n);
                lengths[p * 24 + j] = static_cast<float>(n);
            }
    Motion still = places;
    for (std::uint32_t t = 0; t < frames; ++t)
        for (std::uint32_t p = 0; p < persons; ++p)
            for (std::uint32_t j = 0; j < 24; ++j)
                for (int d = 0; d < 3; ++d)
                    still.values[((t * persons + p) * 24 + j) * 3 + d] =
                        places.at(0, p, j)[d] - places.at(0, p, 0)[d] + places.at(t, p, 0)[d];
    const auto expected = CommonJoints(body(Representation::xyz, smpl24()), "").of(still);
    auto known = body(Representation::limb, smpl24());
    known.bone_length = lengths;
    expect_near(CommonJoints(known, "").of(limbs), expected, 2e-6);  // of float32 positions about 3 m away
    EXPECT_THROW(CommonJoints(body(Representation::limb, smpl24()), "walks"), Error);
}

TEST(CommonJoints, AreOfKnownSkeletonsAlone) {
    try {
        CommonJoints(body(Representation::xyz, {{"a", "b"}, {-1, 0}}), "walks");
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(
            std::string(e.what()),
            "walks: its 2 joints are not those of NTU RGB+D, GTA Combat or SMPL, which alone can be seen as "
            "15 common joints");
    }
}

TEST(CommonJoints, OfABodyWithoutLegsKeepItsMeasure) {
    auto motion = positions("common15", common15());
    for (std::uint32_t t = 0; t < frames; ++t)
        for (std::uint32_t p = 0; p < persons; ++p)
            for (const std::uint32_t j : {10, 11, 13, 14})
                for (int d = 0; d < 3; ++d)
                    motion.values[((t * persons + p) * 15 + j) * 3 + d] = motion.at(t, p, j < 12 ? 9 : 12)[d];
    const auto seen = CommonJoints(body(Representation::xyz, common15()), "").of(motion);
    for (const auto x : seen.values) ASSERT_TRUE(std::isfinite(x));
    EXPECT_NEAR(seen.at(1, 0, 0)[0] - seen.at(0, 0, 0)[0], 0.1, 1e-6);
}
