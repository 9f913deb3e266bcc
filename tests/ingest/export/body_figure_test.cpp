// A .glb with a body's skin, posed by glTF's own rules (the specification's section 3.7.3), against the body's formulas.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/error.hpp"
#include "ingest/export/export.hpp"
#include "ingest/export/gltf/body_figure.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/glb.hpp"
#include "tests/support/made_body.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/turning_motion.hpp"

namespace actformer::ingest {
namespace {

using namespace actformer::test;
using Transform = std::array<double, 16>;  // column by column, as in glTF

Transform chained(const Transform& a, const Transform& b) {
    Transform out{};
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 4; ++k) out[4 * j + i] += a[4 * k + i] * b[4 * j + k];
    return out;
}

Transform local(const std::array<double, 4>& q, const std::array<double, 3>& t) {
    const auto [x, y, z, w] = q;
    return {1 - 2 * (y * y + z * z),
            2 * (x * y + z * w),
            2 * (x * z - y * w),
            0,
            2 * (x * y - z * w),
            1 - 2 * (x * x + z * z),
            2 * (y * z + x * w),
            0,
            2 * (x * z + y * w),
            2 * (y * z - x * w),
            1 - 2 * (x * x + y * y),
            0,
            t[0],
            t[1],
            t[2],
            1};
}

/// World transforms of all nodes at a keyed frame.
std::vector<Transform> world(const Glb& glb, std::size_t frame) {
    const auto& nodes = glb.json["nodes"];
    std::vector<std::array<double, 4>> turns(nodes.size(), {0, 0, 0, 1});
    std::vector<std::array<double, 3>> places(nodes.size(), {0, 0, 0});
    for (std::size_t n = 0; n < nodes.size(); ++n)
        if (nodes[n].contains("translation"))
            places[n] = nodes[n]["translation"].get<std::array<double, 3>>();
    const auto& animation = glb.json["animations"][0];
    for (const auto& channel : animation["channels"]) {
        const auto values =
            glb.floats(animation["samplers"][channel["sampler"].get<std::size_t>()]["output"]);
        const auto node = channel["target"]["node"].get<std::size_t>();
        if (channel["target"]["path"] == "rotation")
            std::copy_n(&values[4 * frame], 4, turns[node].begin());
        else
            std::copy_n(&values[3 * frame], 3, places[node].begin());
    }
    std::vector<Transform> out(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) out[n] = local(turns[n], places[n]);
    for (std::size_t n = 0; n < nodes.size(); ++n)  // parents come first
        if (nodes[n].contains("children"))
            for (const std::size_t child : nodes[n]["children"]) out[child] = chained(out[n], out[child]);
    return out;
}

/// (vertices, 3) of a person.
std::vector<double> skinned(const Glb& glb, std::size_t person, std::size_t frame) {
    const auto& skin = glb.json["skins"][person];
    const auto& primitive = glb.json["meshes"][person]["primitives"][0];
    const auto& attributes = primitive["attributes"];
    const auto at = glb.floats(attributes["POSITION"]), weights = glb.floats(attributes["WEIGHTS_0"]),
               binds = glb.floats(skin["inverseBindMatrices"]);
    const auto joints = glb.numbers<std::uint16_t>(attributes["JOINTS_0"], 5123);
    const auto all = world(glb, frame);
    std::vector<Transform> transforms;
    for (std::size_t k = 0; k < 24; ++k) {
        Transform bind;
        std::copy_n(&binds[16 * k], 16, bind.begin());
        transforms.push_back(chained(all[skin["joints"][k].get<std::size_t>()], bind));
    }
    std::vector<double> out(at.size(), 0);
    for (std::size_t v = 0; v < at.size() / 3; ++v) {
        float sum = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto& m = transforms[joints[4 * v + i]];
            sum += weights[4 * v + i];
            for (std::size_t d = 0; d < 3; ++d)
                out[3 * v + d] += weights[4 * v + i] * (m[d] * at[3 * v] + m[4 + d] * at[3 * v + 1] +
                                                        m[8 + d] * at[3 * v + 2] + m[12 + d]);
        }
        EXPECT_NEAR(sum, 1, 1e-6);
    }
    return out;
}

/// Of a body without pose blend shapes: what the formulas say with R - I left out.
std::filesystem::path write_stiff_body(const TempDir& folder) {
    auto body = made_body();
    for (auto& v : body["posedirs"].values) v = 0;
    write_body(folder / "body.npz", body);
    return folder / "body.npz";
}

}  // namespace

// float32 rotations turn by 1e-7 or less each: nine bones of half a metre make it 1e-6 m.
TEST(BodyFigureOnDevice, TheSkinFollowsTheJointsAsTheModelDoes) {
    const TempDir folder;
    constexpr std::uint32_t frames = 7, persons = 2;
    write_turning_motion(folder / "walk.h5", frames, persons);
    const auto path = write_stiff_body(folder);
    ExportRequest request{folder / "walk.h5", folder / "walk.glb", {}, {}, path, {}};
    const auto summary = export_clips(request);
    ASSERT_EQ(summary.notes.size(), 1U);
    EXPECT_NE(summary.notes[0].find("without pose blend shapes"), std::string::npos);
    const auto glb = parsed(read_file(folder / "walk.glb"));

    const auto body = read_smpl_body(path);
    const auto motion = turning_motion("", frames, persons);
    kernels::Device device;
    kernels::Skinning skinning(device, body.skin);
    for (std::size_t p = 0; p < persons; ++p) {
        EXPECT_EQ(glb.numbers<std::uint32_t>(glb.json["meshes"][p]["primitives"][0]["indices"], 5125),
                  body.faces);
        std::vector<float> rotations, translations;
        for (std::size_t t = 0; t < frames; ++t) {
            for (std::size_t j = 0; j < 24; ++j)
                for (const double r : rotation_of(motion.at(t, p, j)))
                    rotations.push_back(static_cast<float>(r));
            translations.insert(translations.end(), motion.at(t, p, 24), motion.at(t, p, 24) + 3);
        }
        skinning.pose(rotations, translations);
        const auto want = skinning.vertices().download();
        for (const std::size_t t : {0U, 3U, 6U}) {
            const auto got = skinned(glb, p, t);
            for (std::size_t i = 0; i < got.size(); ++i)
                ASSERT_NEAR(got[i], want[t * got.size() + i], 3e-6) << "person " << p << ", frame " << t;
        }
    }
    // One body serves both persons.
    EXPECT_EQ(glb.json["meshes"][0]["primitives"][0]["attributes"],
              glb.json["meshes"][1]["primitives"][0]["attributes"]);
}

TEST(BodyFigure, NormalsPointOutwards) {
    const TempDir folder;
    write_body(folder / "body.npz", made_body());
    const auto figure = body_figure(read_smpl_body(folder / "body.npz"));
    // A tube's vertices lie about the middle of their ring: here rings of six, caps left out.
    double inwards = 0;
    for (std::size_t ring = 0; ring < figure.corners() / 6; ++ring) {
        if (ring % 6 == 0 || ring % 6 == 5) continue;
        std::array<double, 3> middle{};
        for (std::size_t c = 6 * ring; c < 6 * ring + 6; ++c)
            for (std::size_t d = 0; d < 3; ++d) middle[d] += figure.positions[3 * c + d] / 6.0;
        for (std::size_t c = 6 * ring; c < 6 * ring + 6; ++c) {
            double along = 0, length = 0;
            for (std::size_t d = 0; d < 3; ++d) {
                along += figure.normals[3 * c + d] * (figure.positions[3 * c + d] - middle[d]);
                length += figure.normals[3 * c + d] * figure.normals[3 * c + d];
            }
            inwards += along < 0;
            EXPECT_NEAR(length, 1, 1e-5);
        }
    }
    EXPECT_EQ(inwards, 0);
}

TEST(BodyFigure, KeepsTheFourLargestWeights) {
    const TempDir folder;
    auto body = made_body();
    for (std::size_t k = 0; k < 24; ++k) body["weights"].values[k] = 0;
    const std::array<double, 6> shares{0.1, 0.25, 0.05, 0.3, 0.2, 0.1};
    for (std::size_t k = 0; k < 6; ++k) body["weights"].values[k] = shares[k];
    write_body(folder / "body.npz", body);
    const auto figure = body_figure(read_smpl_body(folder / "body.npz"));
    const std::array<int, 4> joints{3, 1, 4, 0};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(figure.joints[i], joints[i]);
        EXPECT_NEAR(figure.weights[i], shares[static_cast<std::size_t>(joints[i])] / 0.85, 1e-6);
    }
}

TEST(ExportWithBody, IsForRotationsAndGlbAlone) {
    const TempDir folder;
    write_turning_motion(folder / "walk.h5");
    const auto body = write_stiff_body(folder);
    ExportRequest request{folder / "walk.h5", folder / "walk.bvh", {}, {}, body, {}};
    EXPECT_NE(error_of([&] { export_clips(request); }).find("a .bvh holds no skin"), std::string::npos)
        << error_of([&] { export_clips(request); });
    request.out = folder / "walk.glb";
    request.body = folder / "none.npz";
    EXPECT_NE(error_of([&] { export_clips(request); }).find("none.npz"), std::string::npos)
        << error_of([&] { export_clips(request); });
    EXPECT_FALSE(std::filesystem::exists(request.out));

    Motion limbs{"A001_0", 3, 1, 24, 3, std::vector<float>(3 * 24 * 3, 0.0F)};
    for (std::size_t i = 0; i < limbs.values.size(); i += 3) limbs.values[i] = 1;
    Subjects subjects;
    subjects.topology = smpl24();
    subjects.bone_length.assign(24, 0.2F);
    MotionsWriter file(folder / "limbs.h5");
    file.describe(subjects);
    file.add("A001_0", limbs);
    file.finish();
    request = {folder / "limbs.h5", folder / "limbs.glb", {}, {}, body, {}};
    EXPECT_NE(error_of([&] { export_clips(request); }).find("limbs.h5: motions are limb of 24 joints"),
              std::string::npos)
        << error_of([&] { export_clips(request); });
}

}  // namespace actformer::ingest
