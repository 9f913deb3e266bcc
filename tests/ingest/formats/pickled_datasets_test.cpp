// NTU-13, NTURecon, HumanAct12 and UESTC: samples against NumPy and SciPy, small files against closed forms, and bad ones.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/error.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/formats/humanact12/array_name.hpp"
#include "ingest/formats/humanact12/humanact12_command.hpp"
#include "ingest/formats/humanact12/humanact12_format.hpp"
#include "ingest/formats/ntu13/ntu13_command.hpp"
#include "ingest/formats/ntu13/ntu13_format.hpp"
#include "ingest/formats/nturecon/nturecon_format.hpp"
#include "ingest/formats/uestc/uestc_format.hpp"
#include "ingest/formats/uestc/video.hpp"
#include "ingest/pipeline/pipeline.hpp"
#include "tests/support/arrays.hpp"
#include "tests/support/command.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/made_body.hpp"
#include "tests/support/pickle_text.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

using Numbers = std::vector<double>;
using Left = std::map<std::string, std::uint64_t>;
using From = HumanAct12Options::From;

const std::string samples = shared("data/raw_format_samples");

struct PickledOnDevice : testing::Test {
    IngestSummary run(Format& format, const fs::path& raw) {
        IngestRequest request;
        request.raw = {raw};
        request.out = dir / "out";
        request.one_dataset = true;
        request.threads = 2;
        return ingest::ingest(request, format, device);
    }

    /// Of files below raw/.
    IngestSummary run(Format& format) { return run(format, dir / "raw"); }

    std::string fault(Format& format) {
        try {
            run(format);
            return "taken";
        } catch (const Error& e) {
            return e.what();
        }
    }

    void add(const std::string& name, const std::string& text) const {
        write_file(dir / ("raw/" + name), text);
    }

    std::string rejected() const { return read_file(dir / "out/rejected.csv"); }
    Dataset made() const { return Dataset(dir / "out"); }

    void expect_says(const std::string& text, const std::string& part) const {
        EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
    }

    TempDir dir;
    kernels::Device device;
};

/// Samples, ingested and compared with what Python makes of them.
struct SampledOnDevice : PickledOnDevice {
    void SetUp() override {
        if (!fs::exists(samples)) GTEST_SKIP() << "needs " << samples;
        static const bool has_python = python_has("h5py, scipy");
        if (!has_python) GTEST_SKIP() << "needs /usr/bin/python3 with h5py and scipy";
    }

    void agree(const std::string& what, const std::string& raw) const {
        const auto compared =
            run_command("/usr/bin/python3 " + source("tests/ingest/formats/pickled_datasets.py") + " " +
                        what + " " + raw + " " + (dir / "out").string());
        EXPECT_EQ(compared.exit, 0) << compared.output;
    }
};

RotationalTarget limbs() {
    RotationalTarget target;
    target.representation = Representation::limb;
    return target;
}

TEST_F(SampledOnDevice, NtuRecon) {
    NtuReconFormat format("nturecon", {});
    const auto summary = run(format, samples + "/nturecon");
    EXPECT_EQ(summary.datasets[0].clips, 12U);
    EXPECT_TRUE(summary.left_out.empty()) << rejected();
    agree("nturecon", samples + "/nturecon");
    const auto dataset = made();
    EXPECT_EQ(dataset.header().classes.size(), 94U);
    EXPECT_EQ(dataset.split("xsub/train").size() + dataset.split("xsub/test").size(), 12U);
    EXPECT_EQ(dataset.header().origin.text(), "recorded, generic skeleton");
}

TEST_F(SampledOnDevice, Ntu13) {
    Ntu13Format format({"ntu13", false, {}, false});
    EXPECT_EQ(run(format, samples + "/ntu13").left_out, (Left{{"dropped", 1}}));
    expect_says(rejected(), "person 1 was not tracked, only the number 2");
    agree("ntu13", samples + "/ntu13");
    EXPECT_EQ(made().header().classes.size(), 13U);
    EXPECT_TRUE(made().header().splits.empty());
}

TEST_F(SampledOnDevice, Ntu13Joints) {
    Ntu13Format format({"ntu13", true, {}, false});
    run(format, samples + "/ntu13");
    agree("ntu13-joints", samples + "/ntu13");
    EXPECT_EQ(made().header().topology.joints(), 18U);
}

TEST(OptionsOfRotations, AreRefusedWhereJointsAreTaken) {
    const TempDir dir;
    write_body(dir / "SMPL.npz", made_body());
    const auto refusals = [](const RotationalOptions& rotations) {
        Ntu13Command ntu13;
        ntu13.rotations = rotations;
        ntu13.from = "joints";
        HumanAct12Command arrays;
        arrays.rotations = rotations;
        return std::pair(error_of([&] { ntu13.open("x"); }), error_of([&] {
                             const auto format = arrays.open("x");
                             format->survey({"raw/a.npy", "a", {}});
                             format->settle();
                         }));
    };
    const auto refused = [](const std::string& option) {
        const auto why =
            option + " is of rotations, and joints are taken; leave it out, or give --from rotations";
        return std::pair(why, why);
    };
    EXPECT_EQ(refusals({"", (dir / "SMPL.npz").string()}), refused("--body"));
    EXPECT_EQ(refusals({"rot6d", ""}), refused("--representation rot6d"));
    EXPECT_EQ(refusals({"xyz", ""}), std::pair(std::string(), std::string()));
    EXPECT_EQ(refusals({"", ""}), std::pair(std::string(), std::string()));
}

TEST_F(SampledOnDevice, HumanAct12) {
    HumanAct12Format format({"humanact12", From::files, {}, 30, false});
    EXPECT_EQ(run(format, samples + "/humanact12").left_out, (Left{{"dropped", 10}}));
    agree("humanact12", samples + "/humanact12");
}

TEST_F(SampledOnDevice, HumanAct12OutOfItsArchive) {
    HumanAct12Format format({"humanact12", From::files, {}, 30, false});
    EXPECT_TRUE(run(format, samples + "/humanact12/HumanAct12Poses.tar.gz").left_out.empty());
    agree("humanact12", samples + "/humanact12");
}

TEST_F(SampledOnDevice, HumanAct12Joints) {
    HumanAct12Format format({"humanact12", From::joints, {}, 30, false});
    const auto summary = run(format, samples + "/humanact12");
    EXPECT_EQ(summary.left_out, (Left{{"dropped", 1}}));
    agree("humanact12-joints", samples + "/humanact12");
    std::string remarks;
    for (const auto& remark : summary.remarks) remarks += remark + "\n";
    expect_says(remarks, "10 files; HumanAct12 was published with 1191");
    expect_says(remarks, "1 archive in ");
}

TEST_F(SampledOnDevice, HumanAct12JointsOfThePickleAreThoseOfTheArrays) {
    HumanAct12Format format({"humanact12", From::joints, {}, 30, false});
    run(format, samples + "/humanact12/HumanAct12Poses");
    fs::rename(dir / "out", dir / "pickle");
    HumanAct12Format arrays({"humanact12", From::joints, {}, 30, false});
    run(arrays, samples + "/humanact12/HumanAct12");
    const Dataset from_pickle(dir / "pickle"), from_arrays(dir / "out");
    const auto by_name = [](const Dataset& dataset) {
        std::map<std::string, std::size_t> clips;
        for (std::size_t i = 0; i < dataset.clips().size(); ++i) clips.emplace(dataset.clips()[i].name, i);
        return clips;
    };
    // "A001_0000" counts clips of the pickle as "P01G01R01F0001T0090A0104" does performers: their order is the same.
    const auto of_pickle = by_name(from_pickle), of_arrays = by_name(from_arrays);
    ASSERT_EQ(of_pickle.size(), 10U);
    ASSERT_EQ(of_arrays.size(), 10U);
    auto array = of_arrays.begin();
    for (const auto& [name, i] : of_pickle) {
        const auto& [array_name, j] = *array++;
        EXPECT_EQ(from_pickle.clips()[i].label, from_arrays.clips()[j].label) << name << ", " << array_name;
        const auto a = from_pickle.motion(i), b = from_arrays.motion(j);
        ASSERT_FALSE(a.values.empty()) << name;
        ASSERT_EQ(a.values.size(), b.values.size()) << name << ", " << array_name;
        // The files' numbers are the same to the bit; float32 of some metres, cleaned in other batches, is exact to less.
        for (std::size_t k = 0; k < a.values.size(); ++k)
            ASSERT_NEAR(a.values[k], b.values[k], 1e-5) << name << ", " << array_name << ", " << k;
    }
}

TEST_F(SampledOnDevice, Uestc) {
    UestcFormat format("uestc", {});
    EXPECT_EQ(run(format, samples + "/uestc").left_out, (Left{{"dropped", 3}}));
    expect_says(rejected(), "a0_d8_p006_c2_color.avi: moving camera, pose unknown");
    agree("uestc", samples + "/uestc");
    const auto dataset = made();
    EXPECT_EQ(dataset.split("train").size(), 3U);
    EXPECT_EQ(dataset.split("test").size(), 6U);
}

// NTURecon --------------------------------------------------------------------------------------------------------------------------

/// Two frames: the root a quarter turn about y in the first; in the second two metres, four and six away.
std::string recon(std::size_t numbers = 72) {
    Numbers poses(2 * numbers, 0.0);
    poses[1] = std::acos(-1) / 2;
    return pickled::file(pickled::dict({{"smpl_loss", pickled::whole(1)},
                                        {"smpl_poses", pickled::array({2, numbers}, poses)},
                                        {"smpl_scaling", pickled::array({1}, {2})},
                                        {"smpl_trans", pickled::array({2, 3}, {0, 0, 0, 4, 8, 12})}}));
}

TEST_F(PickledOnDevice, NtuReconIsTurnedUprightScaledAndCentred) {
    add("S001C001P001R001A061_body0.pkl", recon());
    NtuReconFormat format("recon", {});
    run(format);
    const auto dataset = made();
    EXPECT_EQ(dataset.clips()[0].label, 49U);  // behind 1 to 49
    EXPECT_EQ(dataset.clips()[0].fields, (std::vector<std::string>{"1", "1", "1", "1", "61"}));
    EXPECT_EQ(dataset.split("xsub/train").size(), 1U);
    const auto motion = dataset.motion(0);
    const std::vector<float> root{0, 0, 1, 0, -1, 0}, still{1, 0, 0, 0, 1, 0}, way{-1, 2, 3, 0, 0, 0};
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(motion.at(0, 0, 0)[i], root[i], 1e-7) << i;
        EXPECT_NEAR(motion.at(0, 0, 5)[i], still[i], 1e-7) << i;
        EXPECT_NEAR(motion.at(0, 0, 24)[i], way[i], 1e-7) << i;
        EXPECT_NEAR(motion.at(1, 0, 24)[i], -way[i], 1e-7) << i;
    }
}

TEST_F(PickledOnDevice, NtuReconTakesLimbsOfTheSkeleton) {
    add("S001C001P001R001A001_body0.pkl", recon());
    NtuReconFormat format("recon", limbs());
    run(format);
    const auto motion = made().motion(0);
    EXPECT_EQ(motion.nodes, 24U);
    // The spine points up in the second frame.
    EXPECT_LT(motion.at(1, 0, 3)[1], -0.9F)
        << "a body whose root is not turned hangs in the frame of a camera";
}

TEST_F(PickledOnDevice, NtuReconLeavesOutWhatItCannotUseAndSaysWhy) {
    add("S001C001P001R001A001_body0.pkl", recon());
    add("S001C001P001R001A001_body1.pkl", recon());
    add("S001C001P001R001A050_body0.pkl", recon());
    add("S001C001P001R001A002_body0.pkl", recon(156));
    add("S001C001P001R001A003_body0.pkl", recon(165));
    add("S001C001P001R001A004_body0.pkl", "\x80\x02(cposix\nsystem\nU\2idtR.");
    add("S001C001P001R001A005_body0.pkl", "<!DOCTYPE html><html>Sign in</html>");
    add("S001C001P001R001A006_body0.pkl", recon().substr(0, 900));
    add("S001C001P001R001A007_body0.pkl", pickled::file(pickled::dict({{"pose", pickled::whole(1)}})));
    add("nobody.pkl", recon());
    NtuReconFormat format("recon", {});
    EXPECT_EQ(run(format).left_out, (Left{{"broken", 7}, {"dropped", 2}}));
    for (const auto* part :
         {"body 1 of an action of one person", "action 50 is of two persons",
          "'smpl_poses' (2, 156) has 52 joints, as SMPL+H has", "(2, 165) has 55 joints, as SMPL-X has",
          "posix system at byte 3 is none of the names", "an HTML page in place of a pickle", "cut short",
          "without 'smpl_poses'; it has 'pose'", "the name is not SsssCcccPpppRrrrAaaa_bodyK"})
        expect_says(rejected(), part);
}

// NTU-13 ----------------------------------------------------------------------------------------------------------------------------

/// `frames` of a person who stands still.
std::string tracked(std::size_t frames, std::int32_t person = 1) {
    const auto vibe =
        pickled::dict({{"pose", pickled::array({frames, 72}, Numbers(72 * frames, 0.0))},
                       {"joints3d", pickled::array({frames, 49, 3}, Numbers(147 * frames, 0.5))},
                       {"joints2d", "N"}});
    return pickled::file("}(" + pickled::whole(person) + vibe + "u");
}

TEST_F(PickledOnDevice, Ntu13TakesTheFilesOfItsListAndNamesTheAbsent) {
    add("A/ntu_vibe/S001C001P001R001A006.pkl",
        tracked(2));  // the public tools look for the first A of the path
    add("A/ntu_vibe/S001C001P001R001A007.pkl", tracked(2));
    add("A/ntu_vibe/S001C001P001R001A001.pkl", tracked(2));
    add("A/ntu_vibe/S001C001P001R001A008.pkl", tracked(0));
    add("A/ntu_vibe_list.txt",
        "ntu_vibe/S001C001P001R001A006.pkl\r\nntu_vibe/S001C001P001R001A001.pkl\nntu_vibe/"
        "S001C001P001R001A008.pkl\n"
        "ntu_vibe/S009C001P001R001A099.pkl\n");
    add("A/notes.txt", "mine");
    Ntu13Format format({"ntu13", false, {}, false});
    const auto summary = run(format);
    EXPECT_EQ(summary.left_out, (Left{{"broken", 1}, {"dropped", 2}, {"missing", 1}}));
    EXPECT_EQ(made().clips().size(), 1U);
    EXPECT_EQ(made().clips()[0].label, 0U);
    expect_says(rejected(), "'ntu_vibe/S009C001P001R001A099.pkl': named in the list, and not there");
    expect_says(rejected(), "not in ntu_vibe_list.txt");
    expect_says(rejected(), "action 1 is none of the 13");
    expect_says(rejected(), "no frame");
    ASSERT_EQ(summary.remarks.size(), 1U);
    expect_says(summary.remarks[0], "1 of the 4 files that ntu_vibe_list.txt names are not there");
}

TEST_F(PickledOnDevice, Ntu13WithoutItsListTakesAllFilesAndSaysSo) {
    add("S001C001P001R001A099.pkl", tracked(1));
    Ntu13Format format({"ntu13", false, {}, false});
    const auto summary = run(format);
    EXPECT_EQ(made().clips()[0].label, 10U);
    ASSERT_EQ(summary.remarks.size(), 1U);
    expect_says(summary.remarks[0], "no ntu_vibe_list.txt");
}

TEST_F(PickledOnDevice, AsPublishedBodiesStayInTheFrameOfTheCamera) {
    add("S001C001P001R001A099.pkl", tracked(1));
    Ntu13Format format({"ntu13", false, {}, true});
    run(format);
    const auto motion = made().motion(0);
    const std::vector<float> still{1, 0, 0, 0, 1, 0};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(motion.at(0, 0, 0)[i], still[i], 1e-7) << i;
}

// HumanAct12 ------------------------------------------------------------------------------------------------------------------------

std::string act12(std::size_t poses, std::size_t joints, std::size_t labels, std::size_t numbers = 72) {
    std::vector<std::string> pose, joint, label;
    for (std::size_t i = 0; i < poses; ++i)
        pose.push_back(pickled::array({1, numbers}, Numbers(numbers, 0.1)));
    for (std::size_t i = 0; i < joints; ++i) joint.push_back(pickled::array({1, 24, 3}, Numbers(72, 1.0)));
    for (std::size_t i = 0; i < labels; ++i)
        label.push_back(pickled::whole(static_cast<std::int32_t>(5 * i)));
    return pickled::file(pickled::dict({{"poses", pickled::list(pose)},
                                        {"oldposes", pickled::list({})},
                                        {"joints3D", pickled::list(joint)},
                                        {"y", pickled::list(label)}}));
}

TEST_F(PickledOnDevice, HumanAct12ClipsAreNamedAfterTheirClass) {
    add("humanact12poses.pkl", act12(4, 4, 4));
    HumanAct12Format format({"humanact12", From::files, {}, 15, false});
    EXPECT_EQ(run(format).left_out, (Left{{"broken", 1}}));
    expect_says(rejected(), "clip 3: class 15, none of 0 to 11");
    const auto dataset = made();
    EXPECT_EQ(dataset.header().fps, 15);
    EXPECT_EQ(dataset.header().classes[10], "boxing");
    EXPECT_EQ(dataset.clips()[2].name, "A011_0002");
    EXPECT_EQ(dataset.clips()[2].label, 10U);
}

TEST_F(PickledOnDevice, HumanAct12ListsOfUnequalLengthAreRefused) {
    add("humanact12poses.pkl", act12(3, 2, 3));
    HumanAct12Format format({"humanact12", From::files, {}, 30, false});
    expect_says(fault(format), "'poses' has 3 clips, 'joints3D' 2 and 'y' 3");
}

TEST_F(PickledOnDevice, HumanAct12OfAnotherBodyIsRefused) {
    add("humanact12poses.pkl", act12(1, 1, 1, 156));
    HumanAct12Format format({"humanact12", From::files, {}, 30, false});
    expect_says(fault(format), "clip 0: 'poses' (1, 156) has 52 joints, as SMPL+H has; SMPL's 24 are meant");
}

TEST_F(PickledOnDevice, HumanAct12RotationsNeedThePickle) {
    add("P01G01R01F0001T0002A0101.npy", npy("<f8", "(1, 24, 3)", std::string(8 * 72, '\0')));
    HumanAct12Format format({"humanact12", From::rotations, {}, 30, false});
    expect_says(fault(format), "there is no .pkl file");
}

TEST(HumanAct12Names, AreReadAndOthersRefused) {
    const auto name = parse_array_name("P11G02R03F0812T0862A1203");
    ASSERT_TRUE(name);
    EXPECT_EQ(name->label, 11U);
    EXPECT_EQ(name->fields, (std::vector<std::string>{"11", "2", "3", "812", "862", "12", "1203"}));
    for (const auto* other :
         {"P11G02R03F0812T0862A1301", "P11G02R03F0812T0862A0001", "P11G02R03F0812T0862A120",
          "P11G02R03F0812T0862", "S11G02R03F0812T0862A1203", "P11G02R03F0812T0862A12033", ""})
        EXPECT_FALSE(parse_array_name(other)) << other;
}

// UESTC -----------------------------------------------------------------------------------------------------------------------------

/// Three frames of a body two metres high and wide, who comes nearer.
std::string uestc_pickle(std::size_t videos, std::size_t cameras) {
    Numbers joints(3 * 49 * 3, 0.0), camera{0.5, 0.5, 0, 0, 1, 1, 0, 0, 1, 1, 9, 9};
    for (std::size_t t = 0; t < 3; ++t)
        for (std::size_t corner = 0; corner < 2; ++corner)
            for (std::size_t d = 0; d < 2; ++d) joints[(t * 49 + corner) * 3 + d] = corner == 0 ? -1 : 1;
    const std::vector<std::string> poses(videos, pickled::array({3, 72}, Numbers(216, 0.0))),
        bodies(videos, pickled::array({3, 49, 3}, joints)), views(cameras, pickled::array({3, 4}, camera));
    return pickled::file(pickled::dict({{"pose", pickled::list(poses)},
                                        {"joints3d", pickled::list(bodies)},
                                        {"orig_cam", pickled::list(views)}}));
}

struct UestcOnDevice : PickledOnDevice {
    void SetUp() override {
        add("info/names.txt", "a0_d0_p001_c1_color.avi\na1_d2_p003_c2_color.avi\n");
        add("info/num_frames_min.txt", "2\n2\n");
        add("info/action_classes.txt", "squat\njump\n");
        add("vibe_cache_refined.pkl", uestc_pickle(2, 2));
    }
    UestcFormat format{"uestc", {}};
};

// Two metres are 0.5 * 2 * 270 pixels, then twice as many: 500 * 2 / 270 metres away, then 500 * 2 / 540.
TEST_F(UestcOnDevice, ViewsAreTurnedToTheFrontAndTheWayIsRebuilt) {
    run(format);
    const auto dataset = made();
    ASSERT_EQ(dataset.clips().size(), 2U);
    const auto front = dataset.motion(0), side = dataset.motion(1);
    EXPECT_EQ(front.frames, 2U);
    const float half = 500.0F / 540 * 1.0F;  // of the way
    EXPECT_NEAR(front.at(0, 0, 24)[2], -half, 1e-6);
    EXPECT_NEAR(front.at(0, 0, 24)[0], 0, 1e-6);
    EXPECT_NEAR(side.at(0, 0, 24)[0], -half, 1e-6);
    EXPECT_NEAR(side.at(0, 0, 24)[2], 0, 1e-6);
    const std::vector<float> root{0, 0, -1, 0, -1, 0};  // a quarter turn back about y, then upright
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(side.at(0, 0, 0)[i], root[i], 1e-6) << i;
    EXPECT_EQ(dataset.clips()[1].label, 1U);
    EXPECT_EQ(dataset.clips()[1].fields, (std::vector<std::string>{"2", "2", "3", "2"}));
    EXPECT_EQ(dataset.split("train"), (std::vector<std::size_t>{0}));
    EXPECT_EQ(dataset.split("test"), (std::vector<std::size_t>{1}));
}

TEST_F(UestcOnDevice, NamesAndPickleOfDifferentLengthsAreRefused) {
    add("vibe_cache_refined.pkl", uestc_pickle(3, 3));
    expect_says(fault(format), "3 videos, and names.txt has 2");
}

TEST_F(UestcOnDevice, ListsOfDifferentLengthsAreRefused) {
    add("vibe_cache_refined.pkl", uestc_pickle(2, 1));
    expect_says(fault(format), "'pose' has 2 videos, 'joints3d' 2 and 'orig_cam' 1");
}

TEST_F(UestcOnDevice, ListsThatDoNotFitAreRefused) {
    add("info/num_frames_min.txt", "2\n");
    expect_says(fault(format), "names.txt has 2 videos, and num_frames_min.txt 1");
    UestcFormat words("uestc", {});
    add("info/num_frames_min.txt", "2\ntwo\n");
    expect_says(fault(words), "'two' is no number of frames");
}

TEST_F(UestcOnDevice, WithoutItsListsItSaysWhereTheyAre) {
    fs::remove(dir / "raw/info/names.txt");
    expect_says(fault(format),
                "names.txt is not there, which tells which video is which; it is in the folder info");
}

TEST_F(UestcOnDevice, AListThatIsThereTwiceIsRefusedWhereTheTwoDiffer) {
    add("old/names.txt", read_file(dir / "raw/info/names.txt"));
    add("old/readme.txt", "of old");
    add("readme.txt", "of today");
    EXPECT_EQ(run(format).datasets[0].clips, 2U) << "one is as the other";
    fs::remove_all(dir / "out");
    add("old/names.txt", "a1_d0_p001_c1_color.avi\na1_d2_p003_c2_color.avi\n");
    UestcFormat again("uestc", {});
    EXPECT_EQ(fault(again),
              fmt::format("{0}/old/names.txt: other lines than in {0}/info/names.txt; give the folder or "
                          "archive of one of them alone",
                          (dir / "raw").string()));
}

TEST_F(UestcOnDevice, VideosThatDoNotFitAreLeftOut) {
    add("info/names.txt", "a0_d0_p001_c1_color.avi\na2_d0_p001_c1_color.avi\n");
    EXPECT_EQ(run(format).left_out, (Left{{"broken", 1}}));
    expect_says(rejected(), "a2_d0_p001_c1_color.avi: action 2, and action_classes.txt has 2, from 0");
}

TEST(UestcNames, AreReadAndOthersRefused) {
    const auto name = uestc::parse_video_name("a12_d8_p118_c2_color.avi");
    ASSERT_TRUE(name);
    EXPECT_EQ(name->action, 12U);
    EXPECT_EQ(name->subject, 118);
    EXPECT_FALSE(name->to_front());
    for (const auto* other :
         {"a12_d9_p118_c2_color.avi", "a12_d8_p118_c2_depth.avi", "a_d8_p118_c2_color.avi", "", "a1"})
        EXPECT_FALSE(uestc::parse_video_name(other)) << other;
    int trained = 0;
    for (int subject = 1; subject <= uestc::subjects; ++subject) trained += uestc::trains(subject);
    EXPECT_EQ(trained, 51);
}

}  // namespace
