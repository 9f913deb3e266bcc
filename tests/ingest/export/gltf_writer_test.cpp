// What is written as .glb, read again part by part.
#include "ingest/export/gltf/gltf_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/glb.hpp"
#include "tests/support/skeleton_motion.hpp"

namespace actformer::ingest {
namespace {

using namespace actformer::test;

Point point(const nlohmann::json& json) {
    return {json[0], json[1], json[2]};
}

/// (frames, K) of one skin, by nodes and animation as a viewer takes them.
std::vector<Point> places(const Glb& glb, std::size_t skin, std::uint32_t frames, const Topology& tree) {
    const auto joints = glb.json["skins"].at(skin)["joints"].get<std::vector<std::size_t>>();
    SkeletonMotion motion;
    motion.topology = tree;
    motion.frames = frames;
    motion.rest.resize(joints.size());
    motion.rotation.resize(frames * joints.size());
    motion.position.resize(frames * joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const auto& node = glb.json["nodes"].at(joints[j]);
        for (std::size_t t = 0; t < frames; ++t)
            motion.position[t * joints.size() + j] = point(node["translation"]);
        // The tree of the nodes is that of the joints.
        std::vector<std::size_t> children;
        for (std::size_t c = 0; c < joints.size(); ++c)
            if (tree.parents[c] == static_cast<int>(j)) children.push_back(joints[c]);
        EXPECT_EQ(node.value("children", std::vector<std::size_t>{}), children);
    }
    const auto& animation = glb.json["animations"].at(0);
    for (const auto& channel : animation["channels"]) {
        const auto& sampler = animation["samplers"].at(channel["sampler"].get<std::size_t>());
        const auto values = glb.floats(sampler["output"]);
        const auto found = std::ranges::find(joints, channel["target"]["node"].get<std::size_t>());
        if (found == joints.end()) continue;
        const auto j = static_cast<std::size_t>(found - joints.begin());
        for (std::size_t t = 0; t < frames; ++t)
            if (channel["target"]["path"] == "rotation")
                motion.rotation[t * joints.size() + j] = {values[t * 4 + 3], values[t * 4], values[t * 4 + 1],
                                                          values[t * 4 + 2]};
            else
                motion.position[t * joints.size() + j] = {values[t * 3], values[t * 3 + 1],
                                                          values[t * 3 + 2]};
    }
    return joints_of(motion);
}

// float32 rotations turn by 1e-7 or less each: 20 bones of half a metre make it 1e-6 m.
constexpr double float32_error = 2e-6;

TEST(GltfWriter, SeveralPersonsComeBackFromOneScene) {
    std::mt19937 random(1);
    const auto tree = made_tree(20, random);
    std::vector<SkeletonMotion> persons;
    for (int p = 0; p < 3; ++p) persons.push_back(made_motion(tree, 6, random));
    persons[1].slides[7] = true;
    for (std::size_t t = 0; t < 6; ++t) persons[1].position[t * 20 + 7] = made_point(random, 0.5);
    const auto glb = parsed(glb_bytes(persons, 30, "clip"));
    EXPECT_EQ(glb.json["asset"]["version"], "2.0");
    EXPECT_EQ(glb.json["scenes"].size(), 1U);
    EXPECT_EQ(glb.json["animations"].size(), 1U);
    ASSERT_EQ(glb.json["skins"].size(), 3U);
    for (std::size_t p = 0; p < 3; ++p) {
        const auto want = joints_of(persons[p]), got = places(glb, p, 6, tree);
        for (std::size_t i = 0; i < want.size(); ++i)
            EXPECT_LT(distance(got[i], want[i]), float32_error) << p;
    }
    const auto times = glb.floats(glb.json["animations"][0]["samplers"][0]["input"]);
    ASSERT_EQ(times.size(), 6U);
    for (std::size_t t = 0; t < 6; ++t) EXPECT_FLOAT_EQ(times[t], static_cast<float>(t) / 30.0F);
}

// A vertex of a skin stays where it is in the rest pose, and its tips follow the children.
TEST(GltfWriter, TheBodyHangsOnItsJoints) {
    std::mt19937 random(2);
    const auto tree = made_tree(5, random);
    const auto motion = made_motion(tree, 2, random);
    const auto glb = parsed(glb_bytes({&motion, 1}, 30, "clip"));
    const auto binds = glb.floats(glb.json["skins"][0]["inverseBindMatrices"]);
    auto still = motion;
    for (auto& q : still.rotation) q = {};
    for (std::size_t j = 0; j < 5; ++j) still.position[j] = motion.rest[j];
    const auto rest = joints_of(still);
    for (std::size_t j = 0; j < 5; ++j) {
        for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(binds[j * 16 + 12 + d], -rest[j][d], float32_error);
        EXPECT_EQ(binds[j * 16 + 15], 1);
    }
    const auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
    const auto vertices = glb.floats(attributes["POSITION"]);
    EXPECT_EQ(vertices.size(), 4U * 8 * 3 * 3);  // four bones of eight triangles
    std::size_t on_joints = 0;
    for (std::size_t v = 0; v < vertices.size(); v += 3)
        for (std::size_t j = 0; j < 5; ++j)
            on_joints += distance({vertices[v], vertices[v + 1], vertices[v + 2]}, rest[j]) < float32_error;
    EXPECT_EQ(on_joints, 4U * 8);  // a corner of every triangle is the bone's head or tip
    // From outside, corners run counter-clockwise: normals point away from the bone's middle.
    const auto normals = glb.floats(attributes["NORMAL"]);
    for (std::size_t bone = 0; bone < 4; ++bone) {
        Point middle{};
        for (std::size_t v = 0; v < 24; ++v)
            for (std::size_t d = 0; d < 3; ++d) middle[d] += vertices[(bone * 24 + v) * 3 + d] / 24;
        for (std::size_t v = bone * 24; v < bone * 24 + 24; ++v) {
            double outwards = 0;
            for (std::size_t d = 0; d < 3; ++d)
                outwards += normals[v * 3 + d] * (vertices[v * 3 + d] - middle[d]);
            EXPECT_GT(outwards, 0);
        }
    }
}

TEST(GltfWriter, NamesThatJsonCannotCarryAreMadeFit) {
    std::mt19937 random(3);
    auto motion = made_motion({{"a \"b\"\\", "\xFF\n", "p\xC3\xA4"}, {-1, 0, 0}}, 1, random);
    const auto glb = parsed(glb_bytes({&motion, 1}, 30, "clip \x01"));
    EXPECT_EQ(glb.json["nodes"][1]["name"], "a \"b\"\\");
    EXPECT_EQ(glb.json["nodes"][2]["name"], "\\xFF\\x0A");
    EXPECT_EQ(glb.json["nodes"][3]["name"], "p\xC3\xA4");
    EXPECT_EQ(glb.json["scenes"][0]["name"], "clip \\x01");
}

TEST(GltfWriter, OneJointShowsToo) {
    std::mt19937 random(4);
    const auto motion = made_motion({{"point"}, {-1}}, 3, random);
    const auto glb = parsed(glb_bytes({&motion, 1}, 30, "clip"));
    EXPECT_EQ(glb.floats(glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"]).size(), 72U);
}

}  // namespace
}  // namespace actformer::ingest
