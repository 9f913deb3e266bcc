// `actformer export` as its users meet it, and what other programs make of its files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "ingest/export/fit_name.hpp"
#include "ingest/export/skeletons.hpp"
#include "tests/support/command.hpp"
#include "tests/support/made_body.hpp"
#include "tests/support/skeleton_motion.hpp"
#include "tests/support/toy_dataset.hpp"
#include "tests/support/turning_motion.hpp"

using namespace actformer;
using namespace actformer::test;
using ingest::Point;
namespace fs = std::filesystem;

namespace {

/// The first two-person clip of synthetic NTU: depth-camera bodies, whose joints with several children do not keep their angles.
struct Export : testing::Test {
    std::string clip = ingest::Dataset(toy_pairs()).clips()[0].name;
    TempDir dir;

    std::string at(const std::string& name) const { return (dir / name).string(); }
    void write(const std::string& file, const std::string& more = "") {
        const auto result = run_actformer("export " + toy_pairs().string() + " -o " + at(file) + " --clip " +
                                          clip + " " + more);
        ASSERT_EQ(result.exit, 0) << result.output;
    }
};

TEST_F(Export, SaysWhatItWrote) {
    const auto result = run_actformer("export " + toy_pairs().string() + " -o " + at("all.h5"));
    EXPECT_EQ(result.exit, 0);
    EXPECT_EQ(result.output.find(at("all.h5") + ": "), 0U) << result.output;
    EXPECT_NE(result.output.find(" clips, "), std::string::npos) << result.output;
    const auto json = nlohmann::json::parse(
        run_actformer("export " + toy_pairs().string() + " -o " + at("pair.bvh") + " --json --clip " + clip)
            .output);
    EXPECT_EQ(json["clips"], 1);
    EXPECT_EQ(json["files"], (std::vector<std::string>{at("pair_p1.bvh"), at("pair_p2.bvh")}));
    EXPECT_NE(json["notes"][0].get<std::string>().find("'left shoulder' to 'left_shoulder'"),
              std::string::npos);
}

TEST_F(Export, InspectSaysWhatAMotionsFileHolds) {
    const auto file = at("all.h5");
    ASSERT_EQ(run_actformer("export " + toy().string() + " -o " + file).exit, 0);
    const auto result = run_actformer("inspect " + file);
    EXPECT_EQ(result.exit, 0);
    EXPECT_EQ(result.output,
              file +
                  ": a motions file; actformer render draws it\n  48 motions of 3 classes, each of "
                  "40 frames; 7 joints in limb, 1 person, 30 frames a second\n");
    expect_refused(run_actformer("inspect --verify " + file), {"are for datasets"});
}

TEST_F(Export, ClassesAreCountedFromOneOrNamed) {
    const ingest::Dataset dataset(toy_pairs());
    const auto& name = dataset.header().classes[1];
    for (const auto& label : {std::string("2"), "'" + name + "'"})
        ASSERT_EQ(run_actformer("export " + toy_pairs().string() + " -o " +
                                at(label.substr(0, 1) == "2" ? "a.npz" : "b.npz") + " --class " + label)
                      .exit,
                  0);
    EXPECT_EQ(read_file(dir / "a.npz"), read_file(dir / "b.npz"));
    EXPECT_GT(fs::file_size(dir / "a.npz"), 1000U);
}

TEST_F(Export, ErrorsAreOneLine) {
    const auto input = toy_pairs().string();
    expect_refused(run_actformer("export " + input + " -o " + at("x.fbx")),
                   {"x.fbx", ".h5, .npz, .bvh, .glb"});
    expect_refused(run_actformer("export " + input + " -o " + at("x.glb")), {"holds one clip", "--clip"});
    expect_refused(run_actformer("export " + input + " -o " + at("x.glb") + " --class nothing"),
                   {"no class 'nothing'"});
    const TempDir two;
    fs::create_directory_symlink(toy_pairs(), two / "a");
    fs::create_directory_symlink(toy(), two / "b");
    expect_refused(run_actformer("export " + two.path().string() + " -o " + at("x.h5")),
                   {"2 datasets", "one at a time"});
    expect_refused(run_actformer("export " + (toy_pairs() / "dataset.json").string() + " -o " + at("x.h5")),
                   {"dataset.json", "not an HDF5 file"});
    expect_refused(run_actformer("export " + input + " -o " + at("x.h5") + " --count 0"), {"--count"});
    expect_refused(run_actformer("export " + input + " -o " + at("x.h5") + " --person 0"), {"--person"});
    expect_refused(run_actformer("export " + toy().string() + " -o " + at("x.h5") + " --split s/none"),
                   {"split 's/none'"});
    EXPECT_TRUE(fs::is_empty(dir.path()));
}

/// (frames, persons, joints) of a source's first clip, in the joints' order of `like`, the mean root taken away.
std::vector<Point> centred(const ingest::ClipSource& source, const ingest::Topology& like) {
    const auto fit = [](const std::string& name) { return ingest::fit_name(name, ingest::NameFor::bvh); };
    const auto all = ingest::clip_joints(source.read(0));
    const auto k = like.joints(), bodies = all.size() / k;
    Point mean{};
    for (std::size_t i = 0; i < all.size(); i += k)
        for (std::size_t d = 0; d < 3; ++d) mean[d] += all[i][d] / static_cast<double>(bodies);
    std::vector<Point> out(all.size());
    for (std::size_t j = 0; j < k; ++j) {
        const auto& names = source.subjects().topology.names;
        const auto found = std::ranges::find(names, fit(like.names[j]), fit) - names.begin();
        for (std::size_t i = 0; i < all.size(); i += k)
            for (std::size_t d = 0; d < 3; ++d)
                out[i + j][d] = all[i + static_cast<std::size_t>(found)][d] - mean[d];
    }
    return out;
}

// Persons and joints, where they stand to each other.
TEST_F(Export, BvhComesBackThroughIngest) {
    const auto written =
        run_actformer("export " + toy_pairs().string() + " -o " + at("bvh") + " --format bvh --clip " + clip);
    EXPECT_NE(written.output.find("`ingest bvh --name '{*}A{action}_p{person}'` reads them back"),
              std::string::npos)
        << written.output;
    const auto result =
        run_actformer("ingest bvh " + at("bvh") + " -o " + at("back") + " --name '{*}A{action}_p{person}'");
    ASSERT_EQ(result.exit, 0) << result.output;
    const auto before = ingest::open_clips(toy_pairs()), after = ingest::open_clips(dir / "back");
    ASSERT_EQ(after->clips().size(), 1U) << result.output;
    const auto& topology = before->subjects().topology;
    const auto want = centred(*before, topology), got = centred(*after, topology);
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < want.size(); ++i) EXPECT_LT(distance(got[i], want[i]), 1e-5) << i;
}

TEST_F(Export, SaysHowBvhNamedByClassesIsReadBack) {
    const auto written = run_actformer("export " + toy().string() + " -o " + at("bvh") + " --format bvh");
    EXPECT_NE(written.output.find("`ingest bvh --name '{action}_{index}'` reads them back"),
              std::string::npos)
        << written.output;
    ASSERT_EQ(
        run_actformer("ingest bvh " + at("bvh") + " -o " + at("back") + " --name '{action}_{index}'").exit,
        0);
    EXPECT_EQ(ingest::Dataset(dir / "back").header().classes, ingest::Dataset(toy()).header().classes);
}

TEST_F(Export, PublicLayoutComesBackAsTheSameDataset) {
    for (const auto& folder : {toy_pairs(), toy()}) {
        const ingest::Dataset before(folder);
        ASSERT_EQ(run_actformer("export " + folder.string() + " -o " + at("all.h5")).exit, 0);
        const auto result = run_actformer("ingest motions " + at("all.h5") + " -o " + at("back"));
        ASSERT_EQ(result.exit, 0) << result.output;
        const ingest::Dataset after(dir / "back");
        ASSERT_EQ(after.clips().size(), before.clips().size());
        for (std::size_t i = 0; i < before.clips().size(); ++i) {
            const auto& clip_before = before.clips()[i];
            const auto found = after.find(ingest::public_name(clip_before.name, clip_before.label));
            ASSERT_TRUE(found) << clip_before.name;
            EXPECT_EQ(after.motion(*found).values, before.motion(i).values);
            EXPECT_EQ(after.bone_length(*found), before.bone_length(i));
            EXPECT_EQ(after.header().classes[after.clips()[*found].label],
                      before.header().classes[clip_before.label]);
        }
        fs::remove_all(dir / "back");
    }
}

/// A command that runs Node with the validator where it is; empty where it is not.
std::string gltf_validator() {
    const auto beside = (fs::path(program()).parent_path() / "node_modules").string();
    const auto node = "NODE_PATH=" + beside + ":$(npm root -g 2>/dev/null) node ";
    if (run_command(node + "-e \"require('gltf-validator')\"").exit != 0) return {};
    return node + source("tests/support/validate_gltf.js") + " ";
}

TEST_F(Export, GlbPassesTheValidator) {
    const auto validate = gltf_validator();
    if (validate.empty())
        GTEST_SKIP() << "gltf-validator is not here: npm install --prefix build gltf-validator";
    write("pair.glb");
    EXPECT_EQ(run_command(validate + at("pair.glb")).output, "");
    write("one.glb", "--person 2");
    EXPECT_EQ(run_command(validate + at("one.glb")).output, "");
    write_turning_motion(dir / "walk.h5", 20, 2);
    write_body(dir / "body.npz", made_body());
    const auto skinned =
        run_actformer("export " + at("walk.h5") + " -o " + at("walk.glb") + " --body " + at("body.npz"));
    EXPECT_EQ(skinned.exit, 0) << skinned.output;
    EXPECT_EQ(run_command(validate + at("walk.glb")).output, "");
    write_file(dir / "bad.glb", read_file(dir / "one.glb").substr(0, 5000));
    EXPECT_NE(run_command(validate + at("bad.glb")).output, "");
}

/// What blender_joints.py prints.
std::string blender(const std::string& arguments) {
    const auto output = run_command("blender --background --factory-startup --python-exit-code 1 --python " +
                                    source("tests/support/blender_joints.py") + " -- " + arguments)
                            .output;
    const auto from = output.find("compared ");
    return from == std::string::npos ? output : output.substr(from, output.find('\n', from) - from);
}

void expect_within_a_millimetre(const std::string& told, std::size_t joints) {
    const auto at = told.find("furthest ");
    ASSERT_NE(at, std::string::npos) << told;
    EXPECT_EQ(told.find(fmt::format("compared {} joints", joints)), 0U) << told;
    EXPECT_LT(std::stod(told.substr(at + 9)), 1e-3) << told;
}

TEST_F(Export, BlenderHasTheJointsWhereTheyAre) {
    if (run_command("blender --version").exit != 0)
        GTEST_SKIP() << "Blender is not here (apt-get install blender)";
    write("joints.npz");
    write("pair.glb");
    write("pair.bvh");
    const auto frames = ingest::Dataset(toy_pairs()).clips()[0].frames;
    expect_within_a_millimetre(blender(at("pair.glb") + " " + at("joints.npz")), frames * 50);
    for (const char* p : {"0", "1"})
        expect_within_a_millimetre(
            blender(at(p[0] == '0' ? "pair_p1.bvh" : "pair_p2.bvh") + " " + at("joints.npz") + " " + p),
            frames * 25);
}

TEST_F(Export, NumpyLoadsTheJoints) {
    if (!python_has("numpy")) GTEST_SKIP() << "Debian's python3-numpy is not here";
    ASSERT_EQ(run_actformer("export " + toy_pairs().string() + " -o " + at("all.npz")).exit, 0);
    const ingest::Dataset dataset(toy_pairs());
    write_file(dir / "look.py",
               "import numpy, sys\n"
               "f = numpy.load(sys.argv[1])\n"
               "for name, label in zip(f['clips'], f['labels']):\n"
               "    x = f[name]\n"
               "    print(name, label, *x.shape, x.dtype)\n"
               "    bone = numpy.linalg.norm(x[:, :, 13] - x[:, :, 12], axis=-1)  # the left thigh\n"
               "    assert numpy.ptp(bone, axis=0).max() < 1e-6 and 0.2 < bone.mean() < 0.7\n"
               "print(float(f['fps']), *f['parents'], *f['names'][:3], len(f['classes']), f['program'])\n");
    std::string want;
    for (const auto& one : dataset.clips())
        want += fmt::format("{} {} {} 2 25 3 float32\n", one.name, one.label, one.frames);
    want +=
        "30.0 -1 0 20 2 20 4 5 6 20 8 9 10 0 12 13 14 0 16 17 18 1 7 7 11 11 pelvis spine neck 26 "
        "actformer " ACTFORMER_VERSION "\n";
    EXPECT_EQ(run_command("/usr/bin/python3 " + at("look.py") + " " + at("all.npz")).output, want);
}

}  // namespace
