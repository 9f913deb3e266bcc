// Recordings looked at and made to fit: positions, order of joints, persons, height, the axis up, jumps.
#include <gtest/gtest.h>

#include <cmath>

#include "ingest/formats/skeletal/persons.hpp"
#include "ingest/formats/skeletal/pose.hpp"
#include "ingest/formats/skeletal/positions.hpp"
#include "ingest/formats/skeletal/rearrange.hpp"
#include "ingest/formats/skeletal/stance.hpp"

namespace actformer::ingest {
namespace {

using kernels::Channel;
using Names = std::vector<std::string>;

/// A recording put together joint by joint, and frame by frame.
class Builder {
  public:
    Builder& joint(const std::string& name, int parent, const Vector3& offset,
                   std::vector<Channel> channels = {}) {
        RecordedJoint joint;
        joint.name = name;
        joint.parent = parent;
        joint.end_site = name.empty();
        joint.offset = offset;
        joint.first_channel = out_.channels;
        joint.channels = std::move(channels);
        out_.channels += static_cast<std::uint32_t>(joint.channels.size());
        out_.joints.push_back(std::move(joint));
        return *this;
    }

    Recording with(const std::vector<std::vector<float>>& frames) const {
        Recording out = out_;
        out.frames = static_cast<std::uint32_t>(frames.size());
        out.frame_time = 0.1;
        for (std::uint32_t c = 0; c < out.channels; ++c)
            for (const auto& frame : frames) out.values.push_back(frame.at(c));
        return out;
    }

  private:
    Recording out_;
};

const std::vector<Channel> place{Channel::x_position, Channel::y_position, Channel::z_position};

/// Hips that travel, a spine that turns about z, a head, and a leg that turns about x.
Recording body() {
    return Builder()
        .joint("Hips", -1, {}, place)
        .joint("Spine", 0, {0, 40, 0}, {Channel::z_rotation})
        .joint("Head", 1, {0, 30, 0})
        .joint("", 2, {0, 10, 0})
        .joint("Leg", 0, {10, -40, 0}, {Channel::x_rotation})
        .joint("Foot", 4, {0, -45, 0})
        .with({{0, 0, 0, 0, 0}, {1, 0, 0, 90, 0}, {2, 0, 0, 0, 90}});
}

void expect_place(const Vector3& got, const Vector3& want) {
    for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(got[d], want[d], 1e-9) << d;
}

TEST(Pose, PlacesJoints) {
    const auto second = places_of(body(), 1);
    expect_place(second[0], {1, 0, 0});
    expect_place(second[1], {1, 40, 0});
    expect_place(second[2], {-29, 40, 0});
    expect_place(second[3], {-39, 40, 0});
    expect_place(second[5], {11, -85, 0});
    expect_place(places_of(body(), 2)[5], {12, -40, -45});
}

TEST(Rearrange, CutsAndShifts) {
    auto part = cut(body(), 1, 3);
    EXPECT_EQ(part.frames, 2U);
    EXPECT_EQ(std::vector<float>(part.channel(0).begin(), part.channel(0).end()), (std::vector<float>{1, 2}));
    EXPECT_EQ(std::vector<float>(part.channel(4).begin(), part.channel(4).end()),
              (std::vector<float>{0, 90}));
    shift(part, {5, 6, 7});
    expect_place(places_of(part, 0)[5], {16, -79, 7});
    auto still = Builder().joint("Hips", -1, {}, {Channel::z_position}).with({{1}});
    shift(still, {5, 6, 7});
    expect_place(places_of(still, 0)[0], {5, 6, 8});
}

TEST(Rearrange, TurnsAnyAxisUp) {
    const std::pair<const char*, Vector3> ups[] = {{"y", {0, 1, 0}},   {"z", {0, 0, 1}}, {"-y", {0, -1, 0}},
                                                   {"-z", {0, 0, -1}}, {"x", {1, 0, 0}}, {"-x", {-1, 0, 0}}};
    for (const auto& [name, direction] : ups) {
        SCOPED_TRACE(name);
        const auto up = up_named(name);
        ASSERT_TRUE(up.has_value());
        EXPECT_EQ(name_of(*up), name);
        EXPECT_EQ(nearest_up({0.3 + direction[0], 0.2 + direction[1], -0.3 + direction[2]}), *up);
        Vector3 offset;
        for (std::size_t d = 0; d < 3; ++d) offset[d] = 7 * direction[d];
        auto recording = Builder().joint("Hips", -1, {}, place).joint("Head", 0, offset).with({{0, 0, 0}});
        auto skeleton = skeleton_below(recording, 0, false);
        turn_up(recording, skeleton, *up);
        const auto places = places_of(recording, 0);
        EXPECT_NEAR(places.back()[1], 7, 1e-9);
        EXPECT_EQ(std::count(skeleton.kept.begin(), skeleton.kept.end(), true), 2);
        EXPECT_EQ(recording.joints[skeleton.root].name, "Hips");
    }
    EXPECT_EQ(up_named("up"), std::nullopt);
}

TEST(Rearrange, MatchesJointsByName) {
    const Topology wanted{{"Hips", "Leg", "Foot", "Spine", "Head"}, {-1, 0, 1, 0, 3}};
    auto recording = body();
    auto skeleton = skeleton_below(recording, 0, false);
    EXPECT_EQ(first_difference(skeleton.topology, wanted), "");
    put_in_order(recording, skeleton, wanted);
    EXPECT_EQ(skeleton.topology, wanted);
    Names kept;
    for (std::size_t j = 0; j < recording.joints.size(); ++j)
        if (skeleton.kept[j]) kept.push_back(recording.joints[j].name);
    EXPECT_EQ(kept, wanted.names);
    // Wherever the joints come, they are where they were: the foot comes third now, the head fifth.
    for (std::uint32_t f = 0; f < 3; ++f) {
        const auto before = places_of(body(), f), after = places_of(recording, f);
        expect_place(after[2], before[5]);
        expect_place(after[4], before[2]);
    }
}

TEST(Skeleton, NamesTheFirstDifferenceInAnyOrder) {
    const Topology wanted{{"a", "b", "c"}, {-1, 0, 1}};
    EXPECT_EQ(first_difference(wanted, wanted), "");
    EXPECT_EQ(first_difference({{"a", "x", "c"}, {-1, 0, 1}}, wanted), "joint 'b' is missing");
    EXPECT_EQ(first_difference({{"a", "b", "c"}, {-1, 0, 0}}, wanted), "'c' hangs below 'a', not 'b'");
    EXPECT_EQ(first_difference({{"a", "b", "d", "c"}, {-1, 0, 1, 1}}, wanted), "one joint too many: 'd'");
    EXPECT_EQ(first_difference({{"a", "c", "b"}, {-1, 0, 1}}, wanted), "'c' hangs below 'a', not 'b'");
    EXPECT_EQ(first_difference({{"a", "c", "b"}, {-1, 2, 0}}, wanted), "");
}

/// Three joints in a row whose positions are noise, the channels of the second missing one axis.
Recording noisy(float noise, float far = 0) {
    return Builder()
        .joint("Hips", -1, {}, place)
        .joint("Spine", 0, {0, 40, 0}, place)
        .joint("Head", 1, {3, 25, 0}, {Channel::x_position, Channel::y_position})
        .joint("", 2, {0, 10, 0}, place)
        .joint("Tip", 2, {0, 0.001, 0}, place)
        .with({{0, 90, 0, noise, -noise, 0, noise, 0, 0, 10, 0, 0, 0, 0},
               {1, 90, 0, 0, noise, far, 0, noise, 0, 10, 0, 0, 0, 0}});
}

TEST(Positions, NoiseIsToldByATolerance) {
    const auto vanishing = [](const Recording& recording) {
        return joints_that_vanish(recording, skeleton_below(recording, 0, true));
    };
    EXPECT_EQ(vanishing(noisy(0)), (Names{"Spine", "Head"}));
    EXPECT_EQ(vanishing(noisy(1e-6F)), (Names{"Spine", "Head"}));
    EXPECT_EQ(vanishing(noisy(1.5F)), (Names{"Spine", "Head"}));  // 1.5 sqrt 2 is within a tenth of 25
    EXPECT_EQ(vanishing(noisy(1e-6F, 39)), Names{"Head"});  // in one frame the spine is as long as its OFFSET
    EXPECT_EQ(vanishing(noisy(25)), Names{});
}

TEST(Positions, AreReplacedAddedOrIgnored) {
    const auto spine = [](Positions positions) {
        auto recording = noisy(2);
        settle_positions(recording, skeleton_below(recording, 0, true), positions);
        return places_of(recording, 0)[1];
    };
    expect_place(spine(Positions::replace), {2, 88, 0});
    expect_place(spine(Positions::add), {2, 128, 0});
    expect_place(spine(Positions::ignore), {0, 130, 0});
    EXPECT_EQ(positions_named("add"), Positions::add);
    EXPECT_EQ(positions_named("sum"), std::nullopt);
}

Recording named(const Names& names) {
    Builder builder;
    builder.joint(names[0], -1, {}, place);
    for (std::size_t j = 1; j < names.size(); ++j)
        builder.joint(names[j], static_cast<int>(j) - 1, {0, 1, 0});
    return builder.with({{0, 0, 0}});
}

TEST(Persons, NamesMayDifferAtEitherEnd) {
    const Topology wanted{{"A_Hips", "A_Leg", "A_Foot"}, {-1, 0, 1}};
    const auto why = [&](const Names& names, const Topology& topology) {
        auto recording = named(names);
        const auto found = find_skeleton(recording, topology);
        return std::holds_alternative<Skeleton>(found) ? std::string("taken") : std::get<std::string>(found);
    };
    EXPECT_EQ(why({"A_Hips", "A_Leg", "A_Foot"}, wanted), "taken");
    EXPECT_EQ(why({"B_Hips", "B_Leg", "B_Foot"}, wanted), "taken");
    EXPECT_EQ(why({"Hips", "Leg", "Foot"}, wanted), "taken");
    EXPECT_EQ(why({"B_Hips", "A_Leg", "B_Foot"}, wanted), "no joint 'A_Hips', the root");
    EXPECT_EQ(why({"Hips2", "Leg2", "Foot2"}, {{"Hips", "Leg", "Foot"}, {-1, 0, 1}}), "taken");
    EXPECT_EQ(why({"Hips", "Leg", "Foot"}, {{"Hips:1", "Leg:1", "Foot:1"}, {-1, 0, 1}}), "taken");
    EXPECT_EQ(why({"two:World", "two:Hips", "two:Leg"}, {{"one:Hips", "one:Leg"}, {-1, 0}}), "taken");
    EXPECT_EQ(why({"Hips2", "Leg2", "Toe2"}, {{"Hips", "Leg", "Foot"}, {-1, 0, 1}}),
              "no joint 'Hips', the root");
    auto recording = named({"B_Hips", "B_Leg", "B_Foot"});
    EXPECT_EQ(std::get<Skeleton>(find_skeleton(recording, wanted)).topology, wanted);
}

TEST(Stance, TellsHeightAndDirection) {
    const auto stance = stance_of(body(), 0);
    // Standing, with the spine to the side, with the leg forward: 90 percent exceed nothing beyond the tallest.
    EXPECT_NEAR(stance.extent[1], 165, 1e-9);
    ASSERT_TRUE(stance.upright.has_value());
    EXPECT_EQ(nearest_up(*stance.upright), Up::y);
    const auto nameless = Builder().joint("a", -1, {}, place).joint("b", 0, {0, 1, 0}).with({{0, 0, 0}});
    EXPECT_EQ(stance_of(nameless, 0).upright, std::nullopt);
    EXPECT_NEAR(stance_of(nameless, 0).size, 1, 1e-12);
    // What stands above the root is no part of the body.
    const auto below = Builder()
                           .joint("World", -1, {}, place)
                           .joint("Hips", 0, {0, 900, 0}, place)
                           .joint("Head", 1, {0, 5, 0})
                           .with({{0, 0, 0, 70, 80, 90}});
    EXPECT_NEAR(stance_of(below, 1).extent[1], 5, 1e-9);
}

TEST(Stance, ABodyOnItsSideOrHeadPointsElsewhere) {
    for (const auto& [direction, up] : {std::pair{Vector3{0, 0, 1}, Up::z},
                                        {Vector3{0, -1, 0}, Up::minus_y},
                                        {Vector3{-1, 0, 0}, Up::minus_x}}) {
        Vector3 spine, leg;
        for (std::size_t d = 0; d < 3; ++d) {
            spine[d] = 50 * direction[d];
            leg[d] = -80 * direction[d];
        }
        const auto stance = stance_of(Builder()
                                          .joint("Bip01 Pelvis", -1, {}, place)
                                          .joint("Bip01 Spine", 0, spine)
                                          .joint("Bip01 L Calf", 0, leg)
                                          .with({{0, 0, 0}}),
                                      0);
        ASSERT_TRUE(stance.upright.has_value());
        EXPECT_EQ(nearest_up(*stance.upright), up);
    }
}

TEST(Stance, FindsTheScaleThatFits) {
    EXPECT_EQ(fitting_scale(1.7), 1);
    EXPECT_EQ(fitting_scale(1.2), 1);
    EXPECT_EQ(fitting_scale(175), 0.01);
    EXPECT_EQ(fitting_scale(1650), 0.001);
    EXPECT_EQ(fitting_scale(68), 0.0254);
    EXPECT_NEAR(fitting_scale(30), 0.0564, 1e-4);
    EXPECT_EQ(fitting_scale(5.6), 0.3048);
    EXPECT_NEAR(fitting_scale(0.1), 17, 1e-9);
    EXPECT_NEAR(fitting_scale(17000), 1e-4, 1e-12);
}

Recording steps(const std::vector<float>& x) {
    std::vector<std::vector<float>> frames;
    for (const float v : x) frames.push_back({v, 0, 0});
    return Builder().joint("Hips", -1, {}, place).joint("Head", 0, {0, 10, 0}).with(frames);
}

TEST(Stance, AFirstFrameThatIsElsewhereIsAJump) {
    EXPECT_TRUE(begins_with_jump(steps({0, 50, 51, 52, 53}), 0));
    EXPECT_FALSE(begins_with_jump(steps({0, 5, 10, 15, 20}), 0));       // it walks fast
    EXPECT_FALSE(begins_with_jump(steps({0, 0.5, 0.5, 0.5, 0.5}), 0));  // it is a small start
    EXPECT_FALSE(begins_with_jump(steps({0, 0, 50, 50, 50}), 0));       // it jumps later
    EXPECT_FALSE(begins_with_jump(steps({0, 50}), 0));                  // nothing to compare with
    EXPECT_FALSE(begins_with_jump(steps({0, 50, 90, 140, 160}), 0));
    EXPECT_TRUE(stands_still(steps({3, 3, 3})));
    EXPECT_FALSE(stands_still(steps({3, 3, 4})));
}

}  // namespace
}  // namespace actformer::ingest
