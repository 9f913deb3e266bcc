// The kernels of joints' positions and of their error against libtorch's operations, which are tested against PyTorch (actor/network_test.cpp).
#include "model/generators/rest_joints.hpp"

#include <gtest/gtest.h>

#include "ingest/dataset/known_topologies.hpp"
#include "model/generators/joint_positions.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/tensors.hpp"

using namespace actformer;
using namespace actformer::model;
using namespace actformer::test;

namespace {

RestJoints some_body() {
    const auto offsets = at::randn({24, 3});
    return {ingest::smpl24(),
            {offsets.data_ptr<float>(), offsets.data_ptr<float>() + offsets.numel()},
            "test",
            ""};
}

/// Motions of `persons`, of frames that are no whole vectors, rotations of any length.
at::Tensor some_rotations(std::int64_t persons, at::ScalarType type) {
    return at::randn({3, persons * 6, 21, 25}, type);
}

/// (N, P*6, T, K) -> (N*P*T, joints, 6).
at::Tensor by_joint(const at::Tensor& motion) {
    return motion.unflatten(1, {-1, 6}).permute({0, 1, 3, 4, 2}).flatten(0, 2).slice(1, 0, 24);
}

/// The loss and its gradient to the first motion.
template <typename Loss>
std::pair<at::Tensor, at::Tensor> with_gradient(const at::Tensor& made, const Loss& loss) {
    const auto leaf = made.clone().requires_grad_();
    const auto value = loss(leaf);
    (3 * value).backward();
    return {value.detach(), leaf.grad()};
}

TEST(RestJoints, OfAMotionAreThoseOfItsRotations) {
    at::manual_seed(3);
    const auto body = some_body();
    for (const auto type : {at::kFloat, at::kDouble})
        for (const std::int64_t persons : {1, 2}) {
            const auto motion = some_rotations(persons, type),
                       weights = at::randn({3, persons * 3, 21, 24}, type);
            const auto plain_positions = [&](const at::Tensor& x) {
                return body.positions(by_joint(x))
                    .unflatten(0, {3, persons, 21})
                    .permute({0, 1, 4, 2, 3})
                    .flatten(1, 2);
            };
            const double tolerance =
                type == at::kFloat ? 1e-5 : 1e-13;  // as below; gradients are sums over the joints
            expect_near(body.positions_in(motion), plain_positions(motion), tolerance);
            const auto fused = with_gradient(
                motion, [&](const at::Tensor& x) { return (body.positions_in(x) * weights).sum(); });
            const auto plain = with_gradient(
                motion, [&](const at::Tensor& x) { return (plain_positions(x) * weights).sum(); });
            expect_near(fused.second, plain.second, tolerance * plain.second.abs().max().item<double>());
        }
}

TEST(RestJoints, ErrorIsTheSquaredDistanceOfPositions) {
    at::manual_seed(1);
    const auto body = some_body();
    for (const auto type : {at::kFloat, at::kDouble})
        for (const std::int64_t persons : {1, 2}) {
            const auto made = some_rotations(persons, type), real = some_rotations(persons, type);
            const auto fused = with_gradient(made, [&](const at::Tensor& x) { return body.error(x, real); });
            const auto plain = with_gradient(made, [&](const at::Tensor& x) {
                return (body.positions(by_joint(x)) - body.positions(by_joint(real))).square().mean();
            });
            // Chains of up to ten rotations, each a few roundings.
            const double tolerance = type == at::kFloat ? 1e-5 : 1e-13;
            expect_near(fused.first, plain.first, tolerance * plain.first.item<double>());
            expect_near(fused.second, plain.second, tolerance);
            EXPECT_GT(fused.second.abs().max().item<double>(), 1e-3);
            EXPECT_EQ(fused.second.select(3, 24).abs().max().item<double>(), 0) << "the translation's";
        }
}

TEST(RestJoints, ErrorIsNoneWhereAMotionIsItself) {
    at::manual_seed(2);
    const auto body = some_body();
    const auto motion = some_rotations(2, at::kFloat);
    const auto [value, gradient] =
        with_gradient(motion, [&](const at::Tensor& x) { return body.error(x, motion); });
    EXPECT_EQ(value.item<double>(), 0);
    EXPECT_EQ(gradient.abs().max().item<double>(), 0);
}

TEST(JointPositions, RefuseBodiesWithoutLengthsOrARestSkeleton) {
    const MotionSpec limbs{ingest::Representation::limb, ingest::ntu25(), 1, 2, "data"},
        rotations{ingest::Representation::rot6d, ingest::smpl24(), 1, 2, "data"};
    EXPECT_NE(error_of([&] { JointPositions{limbs}; }).find("data: limbs without lengths"),
              std::string::npos);
    EXPECT_EQ(error_of([&] { JointPositions{rotations}; }),
              "data: rotations without a rest skeleton; ingest it anew, or do without joints (d_joints=0)");
}

}  // namespace
