// Joints and vertices of made bodies against the formulas of SMPL (Loper et al. 2015, equations 2 to 10) in double.
#include "kernels/skinning.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

using namespace actformer;
using namespace actformer::kernels;

namespace {

constexpr std::size_t shape_count = 5;

/// As large as a person: joints within a metre of the root, shapes and pose blend shapes of centimetres.
SkinnedBody made_body(std::size_t vertices, const std::vector<int>& parents, unsigned seed) {
    std::mt19937 random(seed);
    const auto fill = [&](auto& values, std::size_t count, double deviation) {
        std::normal_distribution<double> normal(0, deviation);
        for (std::size_t i = 0; i < count; ++i)
            values.push_back(
                static_cast<typename std::remove_reference_t<decltype(values)>::value_type>(normal(random)));
    };
    SkinnedBody body;
    body.joints.parents = parents;
    fill(body.joints.places, 3 * parents.size(), 0.3);
    fill(body.joints.shapes, shape_count * 3 * parents.size(), 0.01);
    fill(body.rest, 3 * vertices, 0.4);
    fill(body.shapes, shape_count * 3 * vertices, 0.01);
    fill(body.pose_directions, 3 * vertices * 9 * (parents.size() - 1), 0.003);
    body.first.push_back(0);
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto count = 1 + random() % 5;
        for (std::size_t i = 0; i < count; ++i)
            body.influences.push_back(
                {static_cast<std::uint32_t>(random() % parents.size()), 1.0F / static_cast<float>(count)});
        body.first.push_back(static_cast<std::uint32_t>(body.influences.size()));
    }
    return body;
}

/// Rotations (count, 3, 3) about random axes by up to a radian or so.
std::vector<float> made_rotations(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 0.5);
    std::vector<float> out;
    for (std::size_t i = 0; i < count; ++i) {
        const double a = normal(random), b = normal(random), c = normal(random);
        const double n = 1 / std::sqrt(1 + a * a + b * b + c * c), w = n, x = a * n, y = b * n, z = c * n;
        for (const double r : {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
                               2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                               2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)})
            out.push_back(static_cast<float>(r));
    }
    return out;
}

/// One frame by the formulas, in double: 4 x 4 transforms, every vertex by itself.
struct Plain {
    using Matrix = std::array<std::array<double, 4>, 4>;
    std::vector<double> joints, vertices;

    static Matrix product(const Matrix& a, const Matrix& b) {
        Matrix out{};
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                for (std::size_t k = 0; k < 4; ++k) out[i][j] += a[i][k] * b[k][j];
        return out;
    }

    Plain(const SkinnedBody& body, const std::vector<float>& betas, const float* rotations,
          const float* translation) {
        const auto& parents = body.joints.parents;
        const std::size_t k_count = parents.size(), coordinates = body.rest.size();
        std::vector<double> rest(body.joints.places);
        for (std::size_t b = 0; b < betas.size(); ++b)
            for (std::size_t i = 0; i < rest.size(); ++i)
                rest[i] += double{betas[b]} * body.joints.shapes[b * rest.size() + i];
        std::vector<Matrix> world(k_count);
        for (std::size_t k = 0; k < k_count; ++k) {
            Matrix own{};
            own[3][3] = 1;
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j) own[i][j] = rotations[9 * k + 3 * i + j];
                own[i][3] = rest[3 * k + i] - (k ? rest[3 * static_cast<std::size_t>(parents[k]) + i] : 0);
            }
            world[k] = k ? product(world[static_cast<std::size_t>(parents[k])], own) : own;
            for (std::size_t i = 0; i < 3; ++i) joints.push_back(world[k][i][3] + translation[i]);
        }
        for (std::size_t v = 0; v < coordinates / 3; ++v) {
            std::array<double, 3> at{}, out{};
            for (std::size_t d = 0; d < 3; ++d) {
                const auto i = 3 * v + d, features = 9 * (k_count - 1);
                at[d] = body.rest[i];
                for (std::size_t b = 0; b < betas.size(); ++b)
                    at[d] += double{betas[b]} * body.shapes[b * coordinates + i];
                for (std::size_t f = 0; f < features; ++f)
                    at[d] += double{body.pose_directions[i * features + f]} *
                             (double{rotations[9 + f]} - (f % 9 % 4 == 0 ? 1 : 0));
            }
            for (auto s = body.first[v]; s < body.first[v + 1]; ++s) {
                const auto k = body.influences[s].joint;
                for (std::size_t i = 0; i < 3; ++i) {
                    double moved = world[k][i][3];
                    for (std::size_t j = 0; j < 3; ++j) moved += world[k][i][j] * (at[j] - rest[3 * k + j]);
                    out[i] += body.influences[s].weight * moved;
                }
            }
            for (std::size_t i = 0; i < 3; ++i) vertices.push_back(out[i] + translation[i]);
        }
    }
};

void expect_near(const std::vector<float>& got, std::size_t frame, const std::vector<double>& wanted) {
    for (std::size_t i = 0; i < wanted.size(); ++i)
        ASSERT_NEAR(got[frame * wanted.size() + i], wanted[i], 2e-6) << "frame " << frame << ", number " << i;
}

const std::vector<int> smpl{-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};

}  // namespace

// Chains of nine joints reach a few metres, where float32 has 2e-7; a vertex is a sum of some ten such numbers.
TEST(Skinning, AgreesWithTheFormulas) {
    Device device;
    struct Case {
        std::size_t vertices, frames;
        std::vector<int> parents;
    };
    for (const auto& [vertices, frames, parents] :
         {Case{97, 33, smpl}, Case{1, 1, smpl}, Case{131, 64, smpl}, Case{12, 5, {-1, 0, 1, 0}}}) {
        const auto body = made_body(vertices, parents, 3);
        Skinning skinning(device, body);
        const auto rotations = made_rotations(frames * parents.size(), 4);
        std::vector<float> translations, betas{1.5F, -2, 0.3F};
        for (std::size_t i = 0; i < 3 * frames; ++i)
            translations.push_back(static_cast<float>(i % 7) * 0.25F - 0.5F);
        skinning.shape(betas);
        skinning.pose(rotations, translations);
        ASSERT_EQ(skinning.frames(), frames);
        const auto joints = skinning.joints().download(), skin = skinning.vertices().download();
        for (std::size_t t = 0; t < frames; t += std::max<std::size_t>(1, frames / 4)) {
            const Plain plain(body, betas, &rotations[t * parents.size() * 9], &translations[3 * t]);
            expect_near(joints, t, plain.joints);
            expect_near(skin, t, plain.vertices);
        }
    }
}

// As CPUs of narrower vectors and GPUs take them.
TEST(Skinning, AgreesWithTheFormulasInTilesOfAnySize) {
    Device device;
    constexpr std::size_t frames = 70;
    const auto body = made_body(45, smpl, 9);
    const auto rotations = made_rotations(frames * smpl.size(), 10);
    const std::vector<float> translations(3 * frames, 0.25F), betas{1, -1};
    for (const auto& tiles : {SkinningTiles{8, 2, 2, 64, 16, 1}, SkinningTiles{4, 4, 1, 1, 64, 64},
                              SkinningTiles{1, 5, 2, 3, 6, 4}}) {
        Skinning skinning(device, body, tiles);
        skinning.shape(betas);
        skinning.pose(rotations, translations);
        const auto joints = skinning.joints().download(), skin = skinning.vertices().download();
        for (const std::size_t t : {0U, 33U, 69U}) {
            const Plain plain(body, betas, &rotations[t * smpl.size() * 9], &translations[3 * t]);
            expect_near(joints, t, plain.joints);
            expect_near(skin, t, plain.vertices);
        }
    }
}

TEST(Skinning, TakesAnotherShapeAndFewerFrames) {
    Device device;
    const auto body = made_body(50, smpl, 5);
    Skinning skinning(device, body);
    const auto rotations = made_rotations(40 * smpl.size(), 6);
    const std::vector<float> still(120, 0.0F);
    const std::vector<float> tall{2, 0, 0, 0, 1};
    skinning.shape(tall);
    skinning.pose(rotations, still);
    skinning.shape({});
    skinning.pose(std::span(rotations).first(3 * smpl.size() * 9), std::span(still).first(9));
    ASSERT_EQ(skinning.frames(), 3U);
    const Plain plain(body, {}, &rotations[2 * smpl.size() * 9], still.data());
    expect_near(skinning.vertices().download(), 2, plain.vertices);
    expect_near(skinning.joints().download(), 2, plain.joints);
    skinning.pose({}, {});
    EXPECT_EQ(skinning.frames(), 0U);
}

// At rest every vertex stays where the shape has it.
TEST(Skinning, LeavesTheRestPoseAlone) {
    Device device;
    const auto body = made_body(60, smpl, 7);
    Skinning skinning(device, body);
    std::vector<float> rotations(smpl.size() * 9, 0.0F);
    for (std::size_t i = 0; i < rotations.size(); i += 9)
        for (const std::size_t d : {0U, 4U, 8U}) rotations[i + d] = 1;
    skinning.pose(rotations, std::vector<float>(3, 0.0F));
    const auto skin = skinning.vertices().download();
    for (std::size_t i = 0; i < body.rest.size(); ++i) EXPECT_NEAR(skin[i], body.rest[i], 1e-6);
}

TEST(Skinning, RefusesWhatDoesNotFit) {
    Device device;
    const auto body = made_body(10, smpl, 8);
    Skinning skinning(device, body);
    EXPECT_THROW(skinning.shape(std::vector<float>(shape_count + 1, 0.0F)), Error);
    EXPECT_THROW(skinning.pose(std::vector<float>(24 * 9, 0.0F), std::vector<float>(6, 0.0F)), Error);
    const auto refused = [&](auto change) {
        auto other = body;
        change(other);
        EXPECT_THROW(Skinning(device, other), Error);
    };
    refused([](SkinnedBody& b) { b.joints.parents[2] = 3; });
    refused([](SkinnedBody& b) { b.pose_directions.pop_back(); });
    refused([](SkinnedBody& b) { b.shapes.pop_back(); });
    refused([](SkinnedBody& b) { b.joints.places.pop_back(); });
    refused([](SkinnedBody& b) { b.influences[0].joint = 24; });
    refused([](SkinnedBody& b) { b.first[1] = 1000; });
    refused([](SkinnedBody& b) { b.rest.clear(); });
}
