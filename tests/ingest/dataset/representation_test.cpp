// What a representation says of its nodes, and how joints come out of the numbers.
#include "ingest/dataset/representation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "ingest/dataset/body_model.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/made_dataset.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::test;

namespace {

BodyModel arms(Representation how) {
    BodyModel body{how, ArmsClip::topology(), ArmsClip(0, 0, 1).bone_length(), {}};
    if (how == Representation::rot6d)
        for (const auto& offset : ArmsClip::rest)
            body.rest.insert(body.rest.end(), offset.begin(), offset.end());
    return body;
}

/// A chain of two bones of 1 m, and its numbers in rot6d: a root, an elbow, a hand, the translation.
std::vector<float> chain_joints(const std::vector<float>& rotations) {
    const BodyModel body{
        Representation::rot6d, {{"root", "elbow", "hand"}, {-1, 0, 1}}, {}, {0, 0, 0, 1, 0, 0, 1, 0, 0}};
    return joint_positions({"chain", 1, 1, 4, 6, rotations}, body);
}

void expect_near(const std::vector<float>& got, const std::vector<float>& wanted) {
    ASSERT_EQ(got.size(), wanted.size());
    for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], wanted[i], 1e-6) << i;
}

}  // namespace

TEST(Representation, HasANameOfItsOwn) {
    for (const auto how : Representation::all()) EXPECT_EQ(Representation::named(how.name(), "here"), how);
    EXPECT_EQ(error_of([] { Representation::named("quaternion", "d/dataset.json"); }),
              "d/dataset.json: representation 'quaternion' is none of limb, rot6d, xyz");
}

TEST(Representation, KnowsItsNodes) {
    const auto& tree = ArmsClip::topology();
    for (const Representation how : {Representation::limb, Representation::xyz}) {
        EXPECT_EQ(how.numbers(), 3U);
        EXPECT_EQ(how.nodes(tree), 7U);
        EXPECT_EQ(how.node_parents(tree), tree.parents);
    }
    const Representation rotations = Representation::rot6d;
    EXPECT_EQ(rotations.numbers(), 6U);
    EXPECT_EQ(rotations.nodes(tree), 8U);
    EXPECT_EQ(rotations.node_parents(tree), (std::vector<int>{-1, 0, 1, 0, 3, 0, 5, 0}))
        << "the translation hangs on the root";
    EXPECT_EQ(Representation(Representation::limb).free_node(7), 0U);
    EXPECT_EQ(rotations.free_node(8), 7U);
    EXPECT_FALSE(Representation(Representation::xyz).free_node(7));
}

TEST(Rotation, TakesTheFirstTwoRows) {
    // A quarter turn about z takes x to y: R = [0 -1 0; 1 0 0; 0 0 1].
    const float six[6] = {0, -1, 0, 1, 0, 0};
    EXPECT_EQ(rotation_of(six), (Rotation{0, -1, 0, 1, 0, 0, 0, 0, 1}));
    // Gram and Schmidt: lengths and what the second row has of the first do not matter.
    const float loose[6] = {0, -3, 0, 2, 5, 0};
    const auto found = rotation_of(loose);
    const Rotation wanted{0, -1, 0, 1, 0, 0, 0, 0, 1};
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(found[i], wanted[i], 1e-12);
    const float zeros[6] = {};
    for (const auto x : rotation_of(zeros)) EXPECT_EQ(x, 0);
}

TEST(JointPositions, FollowRotationsDownTheTree) {
    // The elbow turned a quarter about z: the forearm points along y.
    expect_near(chain_joints(
                    {1, 0, 0, 0, 1, 0, /**/ 0, -1, 0, 1, 0, 0, /**/ 1, 0, 0, 0, 1, 0, /**/ 0, 0, 0, 0, 0, 0}),
                {0, 0, 0, 1, 0, 0, 1, 1, 0});
    // The root turned a quarter about y, z to x and x to -z, and moved: the elbow's turn comes below it.
    expect_near(chain_joints(
                    {0, 0, 1, 0, 1, 0, /**/ 0, -1, 0, 1, 0, 0, /**/ 1, 0, 0, 0, 1, 0, /**/ 5, 6, 7, 0, 0, 0}),
                {5, 6, 7, 5, 6, 6, 5, 7, 6});
}

TEST(JointPositions, TellTheSameMotionInEveryRepresentation) {
    for (std::uint32_t label = 0; label < 3; ++label) {
        const ArmsClip clip(label, 4, 30);
        std::vector<double> wanted;
        for (std::uint32_t t = 0; t < 30; ++t)
            for (const auto x : clip.positions(t)) wanted.push_back(x);
        for (const auto how : Representation::all()) {
            const auto got = joint_positions(clip.in(how), arms(how));
            ASSERT_EQ(got.size(), wanted.size());
            // Limbs are shorter than 1 by 1e-4 over their length, twice down an arm; else float32's rounding.
            const double tolerance = how == Representation::limb ? 3e-4 : 3e-7;
            for (std::size_t i = 0; i < got.size(); ++i)
                ASSERT_NEAR(got[i], wanted[i], tolerance) << how.name() << " at " << i;
        }
    }
}

TEST(JointPositions, GiveEveryPersonTheFirstOnesLengthsWhereItsOwnAreUnknown) {
    const Motion pair{"pair", 1, 2, 2, 3, {0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0}};
    const BodyModel body{Representation::limb, {{"root", "tip"}, {-1, 0}}, {0, 0.5F}, {}};
    EXPECT_EQ(joint_positions(pair, body), (std::vector<float>{0, 0, 0, 0, 0.5F, 0, 1, 0, 0, 1, 0.5F, 0}));
}

TEST(JointPositions, RefuseWhatDoesNotFit) {
    const ArmsClip clip(0, 0, 2);
    EXPECT_EQ(error_of([&] { joint_positions(clip.in(Representation::limb), arms(Representation::rot6d)); }),
              "c0_0 has 7 nodes of 3 numbers; rot6d of 7 joints has 8 of 6");
    auto body = arms(Representation::rot6d);
    body.rest.pop_back();
    EXPECT_NE(
        error_of([&] { joint_positions(clip.in(Representation::rot6d), body); }).find("rest skeleton of 20"),
        std::string::npos);
    body = arms(Representation::limb);
    body.bone_length.clear();
    EXPECT_NE(error_of([&] { joint_positions(clip.in(Representation::limb), body); }).find("0 limb lengths"),
              std::string::npos);
}

TEST(Motion, TellsPositionsFromLimbs) {
    const ArmsClip clip(1, 3, 30);
    EXPECT_TRUE(has_unit_limbs(clip.in(Representation::limb)));
    EXPECT_FALSE(has_unit_limbs(clip.in(Representation::xyz)));
    EXPECT_FALSE(has_unit_limbs(clip.in(Representation::rot6d)));
    auto short_bones = clip.in(Representation::limb);
    for (std::size_t t = 0; t < 30; ++t)
        for (std::size_t d = 0; d < 3; ++d) short_bones.values[(t * 7 + 2) * 3 + d] = 0;
    EXPECT_TRUE(has_unit_limbs(short_bones)) << "a bone of no length has no direction";
}
