#include "ingest/dataset/body_parts.hpp"

#include <gtest/gtest.h>

#include "ingest/dataset/topology.hpp"

namespace actformer::ingest {
namespace {

using Names = std::vector<std::string>;
using Indices = std::vector<std::size_t>;
using Places = std::vector<std::array<double, 3>>;

TEST(BodyParts, AreToldByNamesInAnyCase) {
    const auto parts =
        body_parts(Names{"Hips", "LowerBack", "HEAD_end", "LeftArm", "RightUpLeg", "lToe", "LeftShoulder"});
    EXPECT_EQ(parts.trunk, (Indices{1, 2})) << "shoulders are to the side";
    EXPECT_EQ(parts.legs, (Indices{4, 5}));
    EXPECT_EQ(body_parts(Names{"root", "l_clavicle", "r_clavicle"}).trunk, (Indices{1, 2}));
    EXPECT_FALSE(body_parts(Names{"a", "b"}).known());
    EXPECT_EQ(body_parts(Names{"Head", "Spine", "Leg"}, 1).trunk, Indices{}) << "what is not below the root";
    EXPECT_EQ(body_parts(ntu25().names).trunk.size(), 4U);  // two of the spine, neck, head
}

TEST(BodyParts, ALegOrArmToTheSideTurnsNoBody) {
    const auto parts = body_parts(Names{"Hips", "Spine", "LeftArm", "LeftLeg"});
    const auto up = upright_direction(Places{{5, 1, 2}, {5, 1.4, 2}, {7, 1.5, 2}, {15, 0.6, 2}}, parts);
    ASSERT_TRUE(up);
    EXPECT_EQ(*up, (std::array<double, 3>{0, 1, 0}));
}

TEST(BodyParts, WithoutATrunkTheLegsTell) {
    const auto parts = body_parts(Names{"Hips", "LeftLeg", "RightLeg"});
    EXPECT_EQ(*upright_direction(Places{{0, 0, 3}, {1, 0, 1}, {-1, 0, 1}}, parts),
              (std::array<double, 3>{0, 0, 1}));
    // A spine that is where the root is tells nothing.
    // One that is there but for noise does not either.
    const auto both = body_parts(Names{"Hips", "Spine", "LeftLeg"});
    EXPECT_EQ(*upright_direction(Places{{0, 0, 0}, {0, 0, 0}, {0, 2, 0}}, both),
              (std::array<double, 3>{0, -1, 0}));
    EXPECT_EQ(*upright_direction(Places{{0, 0, 0}, {1e-6, 0, 0}, {0, -2, 0}}, both),
              (std::array<double, 3>{0, 1, 0}));
    EXPECT_EQ(upright_direction(Places{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, both), std::nullopt);
    EXPECT_EQ(upright_direction(Places{{0, 0, 0}, {1, 0, 0}}, body_parts(Names{"a", "b"})), std::nullopt);
}

}  // namespace
}  // namespace actformer::ingest
