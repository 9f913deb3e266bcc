// SMPL's body model: what its files hold, by SMPL's own formulas in NumPy, and what is refused.
#include "ingest/smpl/body_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "base/error.hpp"
#include "ingest/smpl/model_arrays.hpp"
#include "tests/support/command.hpp"
#include "tests/support/made_body.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::test;

namespace {

std::string toy(const std::string& file) {
    return shared("data/raw_format_samples/smpl_toy/" + file);
}

/// exp of a rotation vector, row by row (Rodrigues 1840).
std::array<double, 9> rotation(double x, double y, double z) {
    const double angle = std::sqrt(x * x + y * y + z * z), s = std::sin(angle) / angle,
                 c = (1 - std::cos(angle)) / (angle * angle), d = std::cos(angle);
    return {d + c * x * x,     c * x * y - s * z, c * x * z + s * y, c * x * y + s * z, d + c * y * y,
            c * y * z - s * x, c * x * z - s * y, c * y * z + s * x, d + c * z * z};
}

std::string refusal(const std::filesystem::path& path) {
    try {
        read_smpl_body(path);
        return "taken";
    } catch (const Error& e) {
        return e.what();
    }
}

/// What a made body with this change is refused for, behind the file's name.
template <typename Change>
std::string refused(Change change) {
    const TempDir folder;
    auto body = made_body();
    change(body);
    write_body(folder / "body.npz", body);
    const auto said = refusal(folder / "body.npz"), where = (folder / "body.npz").string() + ": ";
    EXPECT_EQ(said.substr(0, where.size()), where);
    EXPECT_EQ(said.find('\n'), std::string::npos);
    return said.substr(std::min(said.size(), where.size()));
}

void expect_in(const std::string& said, const std::string& part) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
}

class SmplToyOnDevice : public testing::TestWithParam<const char*> {};

}  // namespace

// float32 vertices within two metres of the origin have 1.2e-7, and are sums of some ten such numbers.
TEST_P(SmplToyOnDevice, JointsAndVerticesAreThoseOfTheFormulas) {
    if (!std::filesystem::exists(toy(GetParam()))) GTEST_SKIP() << "no toy model at hand";
    if (!python_has("numpy")) GTEST_SKIP() << "needs python3-numpy";
    const auto body = read_smpl_body(toy(GetParam()));
    EXPECT_EQ(body.name, GetParam());
    EXPECT_EQ(body.skin.vertices(), 96U);
    EXPECT_EQ(body.faces.size(), 94U * 3);
    EXPECT_EQ(body.skin.joints.shape_count(), 10U);

    constexpr std::size_t frames = 37;
    std::mt19937 random(11);
    std::normal_distribution<double> normal(0, 0.5);
    std::vector<double> vectors, translation;
    std::vector<float> rotations, moved, betas;
    for (std::size_t i = 0; i < frames * smpl_joints; ++i) {
        const double x = normal(random), y = normal(random), z = normal(random);
        vectors.insert(vectors.end(), {x, y, z});
        for (const double r : rotation(x, y, z)) rotations.push_back(static_cast<float>(r));
    }
    for (std::size_t i = 0; i < 3 * frames; ++i) {
        moved.push_back(static_cast<float>(normal(random)));
        translation.push_back(moved.back());
    }
    for (std::size_t b = 0; b < 10; ++b) betas.push_back(static_cast<float>(normal(random)));

    kernels::Device device;
    kernels::Skinning skinning(device, body.skin);
    skinning.shape(betas);
    skinning.pose(rotations, moved);
    const TempDir folder;
    NpzWriter file(folder / "posed.npz");
    file.add("rotation_vectors", {frames, smpl_joints, 3}, vectors);
    file.add("translation", {frames, 3}, translation);
    file.add("betas", {10}, std::vector<double>(betas.begin(), betas.end()));
    file.add("joints", {frames, smpl_joints, 3}, skinning.joints().download());
    file.add("vertices", {frames, 96, 3}, skinning.vertices().download());
    file.finish();
    const auto said = run_command("/usr/bin/python3 " + source("tests/ingest/smpl/smpl_oracle.py") + " " +
                                  toy(GetParam()) + " " + (folder / "posed.npz").string());
    ASSERT_EQ(said.exit, 0) << said.output;
    double joints = 1, vertices = 1;
    std::istringstream numbers(said.output);
    ASSERT_TRUE(numbers >> joints >> vertices) << said.output;
    EXPECT_LT(joints, 1e-6);
    EXPECT_LT(vertices, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Files, SmplToyOnDevice, testing::Values("toy.npz", "toy_chumpy_py2.pkl"));

TEST(SmplBody, JointsComeFromTheVerticesAndFollowTheShape) {
    const TempDir folder;
    write_body(folder / "figure.npz", made_body());
    const auto body = read_smpl_body(folder / "figure.npz");
    const auto generic = generic_skeleton().offsets, rest = body.rest().offsets;
    ASSERT_EQ(rest.size(), 72U);
    for (std::size_t i = 0; i < 72; ++i) EXPECT_NEAR(rest[i], generic[i], 1e-12);
    EXPECT_EQ(body.rest().source, "figure.npz");
    // The first direction makes all heights a twentieth larger, joints' too; two of it, a tenth.
    const auto tall = body.rest(std::vector<float>{2}).offsets;
    for (std::size_t i = 0; i < 72; ++i) EXPECT_NEAR(tall[i], generic[i] * (i % 3 == 1 ? 1.1 : 1), 1e-9);
    EXPECT_THROW(body.rest(std::vector<float>{0, 0, 1}), Error);
}

TEST(SmplBody, TakesMinusOneForTheRootsParent) {
    const TempDir folder;
    auto body = made_body();
    body["kintree_table"].values[0] = -1;
    write_body(folder / "body.npz", body);
    EXPECT_EQ(read_smpl_body(folder / "body.npz").skin.joints.parents[0], -1);
}

TEST(SmplBody, OtherModelsAreRefusedByName) {
    for (const auto& [joints, name] : {std::pair{52, "SMPL+H"}, {55, "SMPL-X"}, {16, "MANO"}})
        expect_in(
            refused([count = static_cast<std::uint64_t>(joints)](MadeBody& b) {
                b["kintree_table"] = {{2, count}, std::vector<double>(2 * count, 0.0)};
            }),
            fmt::format("a body model of {} joints, as {} has, where SMPL's 24 are meant", joints, name));
    expect_in(refused([](MadeBody& b) { b["kintree_table"].values[5] = 3; }),
              "joint 5 hangs on 3, where SMPL's hangs on 2");
    expect_in(refused([](MadeBody& b) { b["kintree_table"].values[24 + 7] = 9; }), "numbers joint 7 as 9");
}

TEST(SmplBody, DamagedModelsAreRefused) {
    expect_in(refused([](MadeBody& b) { b["v_template"].values[4] = NAN; }),
              "'v_template' holds nan as its number 5: damaged");
    expect_in(refused([](MadeBody& b) { b["posedirs"].values[9] = INFINITY; }), "'posedirs' holds inf");
    expect_in(refused([](MadeBody& b) { b["weights"].values[0] += 0.5; }), "'weights' of vertex 0 add up to");
    expect_in(refused([](MadeBody& b) { b["weights"].values[26] = -1; }), "'weights' moves vertex 1 by -1");
    expect_in(refused([](MadeBody& b) { b["f"].values[3] = 1e6; }), "'f' has a face at vertex 1000000");
    expect_in(refused([](MadeBody& b) { b["f"].values[3] = -1; }), "'f' has a face at vertex -1");
    expect_in(refused([](MadeBody& b) { b.erase("posedirs"); }), "no 'posedirs' in it");
    expect_in(refused([](MadeBody& b) {
                  b["posedirs"].shape[2] = 206;
                  b["posedirs"].values.resize(b["posedirs"].shape[0] * 3 * 206);
              }),
              "'posedirs' is (");
    expect_in(refused([](MadeBody& b) {
                  b["v_template"].shape[0] -= 1;
                  b["v_template"].values.resize(b["v_template"].values.size() - 3);
              }),
              "'shapedirs' is (");
    expect_in(refused([](MadeBody& b) { b["v_template"] = {{0, 3}, {}}; }), "'v_template' is (0, 3)");
}

TEST(SmplBody, FilesThatAreNoModelsAreRefused) {
    const TempDir folder;
    write_body(folder / "body.npz", made_body());
    const auto whole = read_file(folder / "body.npz");
    for (const auto tenths : {2U, 9U}) {
        write_file(folder / "cut.npz", whole.substr(0, whole.size() / 10 * tenths));
        expect_in(refusal(folder / "cut.npz"), "cut.npz: ");
    }
    expect_in(refusal(folder / "nowhere.npz"), "nowhere.npz");
    write_file(folder / "page.pkl", "<!DOCTYPE html><html><body>Sign in</body></html>");
    expect_in(refusal(folder / "page.pkl"), "an HTML page in place of a body model");
    write_file(folder / "zeros.pkl", std::string(1000, '\0'));
    expect_in(refusal(folder / "zeros.pkl"), "zeros.pkl: byte 0: ");
    expect_in(refusal(folder / "zeros.pkl"), "; take SMPL's .pkl");
    write_file(folder / "list.pkl", "\x80\x02].");
    expect_in(refusal(folder / "list.pkl"), "a list, not a dict");
    if (std::filesystem::exists(toy("toy_chumpy_py2.pkl"))) {
        write_file(folder / "cut.pkl", read_file(toy("toy_chumpy_py2.pkl")).substr(0, 400'000));
        expect_in(refusal(folder / "cut.pkl"), "cut short");
    }
}

TEST(SmplBody, NothingInAPickleIsRun) {
    const TempDir folder;
    const auto witness = (folder / "run").string();
    write_file(folder / "hostile.pkl", "cos\nsystem\n(S'touch " + witness + "'\ntR.");
    expect_in(refusal(folder / "hostile.pkl"), "os system");
    EXPECT_FALSE(std::filesystem::exists(witness));
}

// As scipy and chumpy write what the toy does not hold: a sparse matrix by its new name, a selection.
TEST(SmplBody, SparseMatricesAndSelectionsOfAPickleComeOutDense) {
    using namespace std::string_literals;
    const auto object = [](const std::string& name, const std::string& state) {
        return "c" + name + "\n)\x81}(" + state + "ub";
    };
    const auto bytes = [&](const std::string& numbers) {
        return fmt::format(
                   "cnumpy.core.multiarray\n_reconstruct\n(cnumpy\nndarray\n(I0\ntS'b'\ntR(I1\n(I{}\nt",
                   numbers.size()) +
               "cnumpy\ndtype\n(S'u1'\nI0\nI1\ntR(I3\nS'|'\nNNNI-1\nI-1\nI0\ntbI00\nU" +
               static_cast<char>(numbers.size()) + numbers + "tb";
    };
    // (2, 3): 5 in row 1 of column 0, 6 in row 0 of column 2.
    const auto sparse = object("scipy.sparse._csc\ncsc_matrix",
                               "S'_shape'\n(I2\nI3\ntS'data'\n" + bytes("\5\6") + "S'indices'\n" +
                                   bytes("\1\0"s) + "S'indptr'\n" + bytes("\0\1\1\2"s));
    const auto select = object("chumpy.reordering\nSelect",
                               "S'a'\n" + object("chumpy.ch\nCh", "S'x'\n" + bytes("\12\13\14")) +
                                   "S'idxs'\n" + bytes("\2\0"s) + "S'preferred_shape'\n(I1\nI2\nt");
    const auto pickle = "\x80\x02}(S'a'\n" + sparse + "S'b'\n" + select + "u.";
    const auto arrays = read_model_pickle(pickle, {"a", "b", "c"});
    ASSERT_EQ(arrays.size(), 2U);
    EXPECT_EQ(arrays.at("a").shape, (std::vector<std::uint64_t>{2, 3}));
    EXPECT_EQ(arrays.at("a").values, (std::vector<double>{0, 0, 6, 5, 0, 0}));
    EXPECT_EQ(arrays.at("b").shape, (std::vector<std::uint64_t>{1, 2}));
    EXPECT_EQ(arrays.at("b").values, (std::vector<double>{12, 10}));

    const auto refused = [&](const std::string& from, const std::string& to) {
        auto other = pickle;
        other.replace(other.find(from), from.size(), to);
        try {
            read_model_pickle(other, {"a", "b"});
            return "taken"s;
        } catch (const Error& e) {
            return std::string(e.what());
        }
    };
    expect_in(refused("U\2\1\0"s, "U\2\1\2"s), "'a': an index of 2 into 2 numbers");
    expect_in(refused("\0\1\1\2"s, "\1\0\1\2"s), "whose parts do not fit");
    expect_in(refused("I1\nI2\nt", "I3\nI2\nt"), "'b': 2 numbers selected for (3, 2)");
    expect_in(refused("I2\nI3\nt", "I2000000000\nI3000000000\nt"), "more numbers than a body model has");
}
