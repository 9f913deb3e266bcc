// Mirrored and turned windows, held against what joints do: in all representations the augmented joints are the joints augmented.
#include "model/train/augmentation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "ingest/dataset/body_model.hpp"
#include "ingest/dataset/known_topologies.hpp"
#include "ingest/dataset/mirror.hpp"
#include "ingest/smpl/smpl24.hpp"

using namespace actformer;
using namespace actformer::ingest;
using model::Augmentation;

namespace {

constexpr std::int64_t count = 6, persons = 2, frames = 5;

BodyModel body_in(Representation representation) {
    BodyModel body{representation, smpl24(), std::vector<float>(2 * smpl_joints), generic_skeleton().rest()};
    const auto other = other_side(smpl24(), "test");
    for (std::uint32_t k = 1; k < smpl_joints; ++k)  // sides as long as one another
        body.bone_length[k] = body.bone_length[smpl_joints + k] =
            0.1F + 0.01F * static_cast<float>(std::min(k, other[k]));
    return body;
}

/// Random motions (count, persons * D, frames, K) as networks give them: unit limbs, rows of rotations, a free position.
at::Tensor motions_in(Representation representation) {
    const auto d = std::int64_t{representation.numbers()}, k = std::int64_t{representation.nodes(smpl24())};
    at::manual_seed(3);
    auto x = at::randn({count, persons, d, frames, k});
    if (representation == Representation::limb) {
        auto limbs = x.narrow(4, 1, k - 1);
        limbs.div_(limbs.norm(2, 2, true));
    } else if (representation == Representation::rot6d) {
        auto rotations = x.narrow(4, 0, k - 1);
        const auto first = rotations.narrow(2, 0, 3) / rotations.narrow(2, 0, 3).norm(2, 2, true);
        auto second = rotations.narrow(2, 3, 3);
        second = second - first * (first * second).sum(2, true);
        rotations.copy_(at::cat({first, second / second.norm(2, 2, true)}, 2));
        x.narrow(4, k - 1, 1).narrow(2, 3, 3).zero_();
    }
    return x.reshape({count, persons * d, frames, k});
}

/// Joints (count, frames, persons, joints, 3) by forward kinematics, which knows nothing of augmentation.
at::Tensor joints_of(const at::Tensor& motions, Representation representation) {
    const auto body = body_in(representation);
    const auto d = std::int64_t{representation.numbers()}, k = motions.size(3);
    std::vector<at::Tensor> all;
    for (std::int64_t i = 0; i < motions.size(0); ++i) {
        const auto values = motions[i].view({persons, d, frames, k}).permute({2, 0, 3, 1}).contiguous();
        Motion motion{"m", frames, persons, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(d), {}};
        motion.values.assign(values.data_ptr<float>(), values.data_ptr<float>() + values.numel());
        auto joints = joint_positions(motion, body);
        all.push_back(at::from_blob(joints.data(), {frames, persons, std::int64_t{smpl_joints}, 3}).clone());
    }
    return at::stack(all);
}

/// The joints with left and right exchanged and x reversed, by plain loops.
at::Tensor reflected(const at::Tensor& joints) {
    const auto other = other_side(smpl24(), "test");
    auto out = at::empty_like(joints);
    for (std::int64_t k = 0; k < joints.size(3); ++k)
        for (std::int64_t c = 0; c < 3; ++c)
            out.select(3, k).select(3, c).copy_(
                joints.select(3, other[static_cast<std::size_t>(k)]).select(3, c) * (c == 0 ? -1 : 1));
    return out;
}

void expect_close(const at::Tensor& a, const at::Tensor& b) {
    // float32 over chains of up to nine joints of at most some metres
    EXPECT_LT((a - b).abs().max().item<float>(), 2e-5F);
}

double share_changed(const model::AugmentationSettings& settings) {
    constexpr std::int64_t many = 4000;
    const auto x = at::randn({many, 3, 2, smpl_joints});
    const auto changed = Augmentation(settings, Representation::xyz, smpl24(), "test")(x, 11).ne(x);
    return changed.flatten(1).any(1).to(at::kDouble).mean().item<double>();
}

}  // namespace

TEST(Augmentation, MirrorsBodiesInEveryRepresentation) {
    for (const auto representation : Representation::all()) {
        const auto motions = motions_in(representation);
        const auto seen = Augmentation({1, 0}, representation, smpl24(), "test")(motions, 5);
        expect_close(joints_of(seen, representation), reflected(joints_of(motions, representation)));
    }
}

TEST(Augmentation, TurnsBodiesAboutTheVerticalInEveryRepresentation) {
    for (const auto representation : Representation::all()) {
        const auto motions = motions_in(representation);
        const auto before = joints_of(motions, representation);
        const auto after =
            joints_of(Augmentation({0, 1}, representation, smpl24(), "test")(motions, 5), representation);
        // As complex numbers x - iz, all joints of a motion times the same number of modulus 1.
        std::vector<double> angles;
        for (std::int64_t i = 0; i < count; ++i) {
            const auto flat = [&](const at::Tensor& joints) {
                return joints[i].reshape({-1, 3}).to(at::kDouble);
            };
            const auto a = flat(before), b = flat(after);
            // The angle of the first joint, then every joint turned by it.
            const auto angle = [](const at::Tensor& v) {
                return std::atan2(-v[2].item<double>(), v[0].item<double>());
            };
            const double by = angle(b[0]) - angle(a[0]);
            const auto turned =
                at::stack({std::cos(by) * a.select(1, 0) + std::sin(by) * a.select(1, 2), a.select(1, 1),
                           std::cos(by) * a.select(1, 2) - std::sin(by) * a.select(1, 0)},
                          1);
            expect_close(b, turned);
            angles.push_back(by);
        }
        EXPECT_GT(std::abs(angles[0] - angles[1]), 1e-3);
    }
}

TEST(Augmentation, ChangesTheShareThatIsAskedFor) {
    // Five deviations of a binomial share of 4,000.
    EXPECT_NEAR(share_changed({0.3, 0}), 0.3, 5 * std::sqrt(0.3 * 0.7 / 4000));
    EXPECT_NEAR(share_changed({0, 0.5}), 0.5, 5 * std::sqrt(0.25 / 4000));
    EXPECT_EQ(share_changed({0, 0}), 0);
    EXPECT_EQ(share_changed({0, 1}), 1);
}

TEST(Augmentation, IsAFunctionOfItsSeed) {
    const auto motions = motions_in(Representation::limb);
    const Augmentation some({0.4, 0.9}, Representation::limb, smpl24(), "test");
    EXPECT_TRUE(some(motions, 1).equal(some(motions, 1)));
    EXPECT_FALSE(some(motions, 1).equal(some(motions, 2)));
}

TEST(Augmentation, LetsGradientsThrough) {
    // Limbs are augmented by an orthogonal map, so <a(x), y> has the gradient a'(y) with |a'(y)| = |y|, and <a(x), a(x)> the gradient 2x.
    auto x = motions_in(Representation::limb).requires_grad_(true);
    const Augmentation some({0.4, 0.9}, Representation::limb, smpl24(), "test");
    some(x, 7).square().sum().backward();
    EXPECT_LT((x.grad() - 2 * x).abs().max().item<float>(), 1e-5F);
}
