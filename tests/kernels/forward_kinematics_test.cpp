// Forward kinematics on the device against quaternions in double precision, on random trees.
#include "kernels/forward_kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace actformer::kernels {
namespace {

struct Vector {
    double x = 0, y = 0, z = 0;
};

struct Quaternion {
    double w = 1, x = 0, y = 0, z = 0;
};

Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Vector rotated(const Quaternion& q, const Vector& v) {
    const Quaternion r = q * Quaternion{0, v.x, v.y, v.z} * Quaternion{q.w, -q.x, -q.y, -q.z};
    return {r.x, r.y, r.z};
}

Quaternion about(Channel axis, double degrees) {
    const double half = degrees * std::acos(-1.0) / 360;
    Quaternion q{std::cos(half), 0, 0, 0};
    (axis == Channel::x_rotation ? q.x : axis == Channel::y_rotation ? q.y : q.z) = std::sin(half);
    return q;
}

struct TestClip {
    std::vector<KinematicJoint> joints;
    std::uint32_t frames = 0;
    std::vector<float> values;

    KinematicClip view() const { return {joints, frames, values}; }
};

/// Every joint's position in the world at one frame, in units of the recording.
std::vector<Vector> world_positions(const TestClip& clip, std::uint32_t frame) {
    std::vector<Vector> positions;
    std::vector<Quaternion> turns;
    std::size_t row = 0;
    for (const auto& joint : clip.joints) {
        Vector place{joint.offset[0], joint.offset[1], joint.offset[2]};
        Quaternion turn;
        for (const auto channel : joint.channels) {
            const double value = clip.values[row++ * clip.frames + frame];
            if (channel == Channel::x_position)
                place.x = value;
            else if (channel == Channel::y_position)
                place.y = value;
            else if (channel == Channel::z_position)
                place.z = value;
            else
                turn = turn * about(channel, value);
        }
        const Quaternion above = joint.parent < 0 ? Quaternion{} : turns[joint.parent];
        const Vector origin = joint.parent < 0 ? Vector{} : positions[joint.parent];
        const Vector moved = rotated(above, place);
        positions.push_back({origin.x + moved.x, origin.y + moved.y, origin.z + moved.z});
        turns.push_back(above * turn);
    }
    return positions;
}

/// Differences of the world's positions between kept joints and their nearest kept ancestors, in metres.
std::vector<double> expected_limbs(const TestClip& clip, double metres_per_unit) {
    std::vector<double> out;
    for (std::uint32_t f = 0; f < clip.frames; ++f) {
        const auto world = world_positions(clip, f);
        for (std::size_t j = 0; j < clip.joints.size(); ++j) {
            if (!clip.joints[j].kept) continue;
            int above = clip.joints[j].parent;
            while (above >= 0 && !clip.joints[above].kept) above = clip.joints[above].parent;
            const Vector from = above < 0 ? Vector{} : world[above];
            for (const double d : {world[j].x - from.x, world[j].y - from.y, world[j].z - from.z})
                out.push_back(d * metres_per_unit);
        }
    }
    return out;
}

class Random {
  public:
    explicit Random(unsigned seed) : engine_(seed) {}
    int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
    float between(double low, double high) {
        return static_cast<float>(std::uniform_real_distribution<double>(low, high)(engine_));
    }

    /// `count` joints depth first, every one kept with the given chance in percent, the root always.
    std::vector<KinematicJoint> tree(int count, int kept_percent) {
        std::vector<KinematicJoint> joints(count);
        for (int j = 0; j < count; ++j) {
            auto& joint = joints[j];
            joint.parent = j - 1;
            while (joint.parent > 0 && below(3) == 0) joint.parent = joints[joint.parent].parent;
            for (auto& o : joint.offset) o = between(-40, 40);
            joint.channels.resize(below(7));
            for (auto& c : joint.channels) c = static_cast<Channel>(below(6));
            joint.kept = j == 0 || below(100) < kept_percent;
        }
        return joints;
    }

    TestClip clip(std::vector<KinematicJoint> joints, std::uint32_t frames) {
        TestClip out{std::move(joints), frames, {}};
        for (const auto& joint : out.joints)
            for (const auto channel : joint.channels)
                for (std::uint32_t f = 0; f < frames; ++f)
                    out.values.push_back(channel < Channel::x_rotation ? between(-60, 60)
                                                                       : between(-360, 360));
        return out;
    }

  private:
    std::mt19937 engine_;
};

void expect_agreement(Device& device, const std::vector<TestClip>& clips, float metres_per_unit,
                      double tolerance) {
    std::vector<KinematicClip> views;
    std::vector<double> want;
    for (const auto& clip : clips) {
        views.push_back(clip.view());
        const auto limbs = expected_limbs(clip, metres_per_unit);
        want.insert(want.end(), limbs.begin(), limbs.end());
    }
    const auto got = forward_kinematics(device, views, metres_per_unit).download();
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < want.size(); ++i) ASSERT_NEAR(got[i], want[i], tolerance) << "number " << i;
}

TEST(ForwardKinematics, AgreesWithQuaternionsOnRandomTrees) {
    Device device;
    Random random(1);
    for (int round = 0; round < 20; ++round) {
        std::vector<TestClip> clips;
        const auto joints = random.tree(1 + random.below(40), round % 2 ? 100 : 60);
        for (int c = 0; c < 8; ++c) clips.push_back(random.clip(joints, 1 + random.below(70)));
        expect_agreement(device, clips, 0.01F, 2e-6);
    }
}

TEST(ForwardKinematics, TakesAnotherSkeletonForEveryClip) {
    Device device;
    Random random(2);
    std::vector<TestClip> clips;
    for (int c = 0; c < 20; ++c) clips.push_back(random.clip(random.tree(23, 100), 1 + random.below(9)));
    expect_agreement(device, clips, 0.01F, 2e-6);
}

TEST(ForwardKinematics, AppliesRotationsInTheOrderOfTheChannels) {
    Device device;
    const KinematicJoint root{-1, {1, 2, 3}, {Channel::z_rotation, Channel::x_rotation}, true};
    const KinematicJoint tip{0, {0, 0, 2}, {}, true};
    // X by a right angle takes z to -y; Z by a right angle then takes -y to x.
    const TestClip clip{{root, tip}, 1, {90, 90}};
    const auto view = clip.view();
    const auto limbs = forward_kinematics(device, {&view, 1}, 1).download();
    const std::vector<float> want = {1, 2, 3, 2, 0, 0};
    ASSERT_EQ(limbs.size(), want.size());
    for (std::size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(limbs[i], want[i], 1e-6) << i;
}

TEST(ForwardKinematics, PositionChannelsTakeThePlaceOfTheOffset) {
    Device device;
    const KinematicJoint root{-1, {1, 2, 3}, {Channel::y_position}, true};
    const KinematicJoint tip{0, {4, 5, 6}, {Channel::z_position, Channel::x_position}, true};
    const TestClip clip{{root, tip}, 2, {20, 21, 30, 31, 40, 41}};
    const auto view = clip.view();
    EXPECT_EQ(forward_kinematics(device, {&view, 1}, 1).download(),
              (std::vector<float>{1, 20, 3, 40, 5, 30, 1, 21, 3, 41, 5, 31}));
}

TEST(ForwardKinematics, LimbsFarFromTheOriginAreAsExactAsNearIt) {
    Device device;
    Random random(3);
    TestClip near = random.clip(random.tree(30, 100), 50);
    near.joints[0].channels.clear();
    near = random.clip(near.joints, 50);
    TestClip far = near;
    far.joints[0].offset = {1e7F, -1e7F, 1e7F};
    const std::vector<KinematicClip> views = {near.view(), far.view()};
    const auto limbs = forward_kinematics(device, views, 0.01F).download();
    for (std::size_t i = 0; i < limbs.size() / 2; ++i) {
        if (i % 90 < 3) continue;  // the root
        ASSERT_EQ(limbs[i], limbs[limbs.size() / 2 + i]) << i;
    }
}

TEST(ForwardKinematics, SummedDownTheTreeLimbsAreJointPositions) {
    Device device;
    Random random(4);
    const TestClip clip = random.clip(random.tree(25, 100), 33);
    const auto view = clip.view();
    const auto limbs = forward_kinematics(device, {&view, 1}, 1).download();
    for (std::uint32_t f = 0; f < clip.frames; ++f) {
        const auto world = world_positions(clip, f);
        std::vector<Vector> sums(clip.joints.size());
        for (std::size_t j = 0; j < clip.joints.size(); ++j) {
            const float* limb = &limbs[(f * clip.joints.size() + j) * 3];
            const Vector from = j == 0 ? Vector{} : sums[clip.joints[j].parent];
            sums[j] = {from.x + limb[0], from.y + limb[1], from.z + limb[2]};
            ASSERT_NEAR(sums[j].x, world[j].x, 1e-3);
            ASSERT_NEAR(sums[j].y, world[j].y, 1e-3);
            ASSERT_NEAR(sums[j].z, world[j].z, 1e-3);
        }
    }
}

TEST(ForwardKinematics, TakesNoClipsAtAll) {
    Device device;
    EXPECT_EQ(forward_kinematics(device, {}, 1).size(), 0U);
}

TEST(ForwardKinematics, RefusesWhatIsNoDepthFirstTree) {
    Device device;
    const auto refused = [&](std::vector<KinematicJoint> joints, std::vector<float> values = {}) {
        const TestClip clip{std::move(joints), 1, std::move(values)};
        const auto view = clip.view();
        EXPECT_THROW(forward_kinematics(device, {&view, 1}, 1), Error);
    };
    const auto joint = [](int parent, bool kept = true) { return KinematicJoint{parent, {}, {}, kept}; };
    refused({joint(0)});
    refused({joint(-1), joint(-1)});
    refused({joint(-1), joint(2), joint(0)});
    refused({joint(-1), joint(0), joint(0), joint(1)});
    refused({joint(-1, false), joint(0), joint(0)});
    refused({joint(-1)}, {1});
    refused({{-1, {}, std::vector<Channel>(7, Channel::x_rotation), true}}, std::vector<float>(7));
}

}  // namespace
}  // namespace actformer::kernels
