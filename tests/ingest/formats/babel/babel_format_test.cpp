// AMASS's layout and BABEL's annotations through the pipeline, with what is often wrong in them.
#include "ingest/formats/babel/babel_format.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "base/error.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/export/npz/npz_writer.hpp"
#include "ingest/formats/babel/categories.hpp"
#include "ingest/pipeline/pipeline.hpp"
#include "tests/support/command.hpp"
#include "tests/support/made_body.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

/// What a file in AMASS's layout says.
struct Recorded {
    std::uint64_t frames = 121, numbers = 156;
    double fps = 120;
    std::string rate = "mocap_framerate";  ///< its name; empty: left out
    double speed = 0.5;  ///< of the left knee about x, radians a second; the body walks as many m/s along x
};

void write_amass(const fs::path& path, const Recorded& r) {
    fs::create_directories(path.parent_path());
    std::vector<double> poses(r.frames * r.numbers), trans(r.frames * 3);
    for (std::uint64_t t = 0; t < r.frames; ++t) {
        const double way = r.speed * static_cast<double>(t) / r.fps;
        if (r.numbers > 14) poses[t * r.numbers + 3 * 4] = way;
        trans[3 * t] = way;
        trans[3 * t + 2] = 0.9;
    }
    NpzWriter npz(path);
    npz.add("gender", "male");
    npz.add("trans", {r.frames, 3}, trans);
    npz.add("poses", {r.frames, r.numbers}, poses);
    npz.add("betas", {16}, std::vector<double>(16));
    if (!r.rate.empty()) npz.add(r.rate, {}, std::vector<double>{r.fps});
    npz.finish();
}

std::string label(const std::string& id, const std::string& categories, const std::string& times) {
    return R"({"raw_label": "x", "proc_label": "does )" + id + R"(", "seg_id": ")" + id +
           R"(", "act_cat": )" + categories + times + "}";
}

std::string sequence(int id, const std::string& file, const std::string& labels, bool frames = true) {
    const auto annotation =
        R"({"babel_lid": "b", "anntr_id": "a", "mul_act": true, "labels": )" + labels + "}";
    return fmt::format(
        R"("{}": {{"babel_sid": {}, "url": "", "feat_p": "{}", "dur": 1.0, "seq_ann": {}, "frame_ann": {}}})",
        id, id, file, frames ? "null" : annotation, frames ? annotation : "null");
}

struct BabelOnDevice : testing::Test {
    BabelOnDevice() { options.dataset = "babel"; }

    IngestSummary run() {
        IngestRequest request;
        request.raw = {dir / "raw"};
        request.out = dir / "out";
        request.one_dataset = true;
        request.threads = 2;
        BabelFormat format(options);
        return ingest::ingest(request, format, device);
    }

    std::string fault() {
        try {
            run();
            return "taken";
        } catch (const Error& e) {
            return e.what();
        }
    }

    /// Reasons of a kind, sorted.
    std::vector<std::string> left_out(const std::string& kind) const {
        std::vector<std::string> out;
        std::istringstream lines(read_file(dir / "out/rejected.csv"));
        for (std::string line; std::getline(lines, line);)
            if (const auto at = line.find("," + kind + ","); at != std::string::npos)
                out.push_back(line.substr(at + kind.size() + 2));
        std::sort(out.begin(), out.end());
        return out;
    }

    void annotate(const std::vector<std::string>& sequences, const std::string& file = "train.json") {
        write_file(dir / "raw" / file, fmt::format("{{{}}}", fmt::join(sequences, ", ")));
    }

    const TempDir dir;
    kernels::Device device{""};
    BabelOptions options;
    const std::string motion = "CMU/CMU/01/01_01_poses.npz";
};

bool any_has(const std::vector<std::string>& lines, const std::string& part) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const auto& line) { return line.find(part) != line.npos; });
}

}  // namespace

TEST(BabelCategories, AreThoseOfBabelOrAnyNamed) {
    EXPECT_EQ(categories_called("120").size(), 120U);
    EXPECT_EQ(categories_called("60").size(), 60U);
    EXPECT_EQ(categories_called("60").back(), categories_called("120")[59]);
    EXPECT_EQ(categories_called("20").back(), categories_called("120")[19]);
    EXPECT_EQ(categories_called("120")[0], "walk");
    EXPECT_EQ(categories_called("120")[119], "sudden movement");
    EXPECT_EQ(categories_called("walk, jump rope"), (std::vector<std::string>{"walk", "jump rope"}));
    const TempDir dir;
    write_file(dir / "names", "duck\r\n\n walk \n");
    EXPECT_EQ(categories_called((dir / "names").string()), (std::vector<std::string>{"duck", "walk"}));
    write_file(dir / "from Windows", "\xEF\xBB\xBFto duck, slowly\r\nwalk\r\n");
    EXPECT_EQ(categories_called((dir / "from Windows").string()),
              (std::vector<std::string>{"to duck, slowly", "walk"}));
    for (const std::string wrong : {"", " , ", "walk,walk", "0", "121"})
        EXPECT_THROW(categories_called(wrong), Error) << wrong;
}

TEST_F(BabelOnDevice, ASplitIsCalledByTheBytesOfAFileThatIsNoUtf8) {
    write_amass(dir / "raw/CMU/01/01_01_poses.npz", {});
    annotate({sequence(7, motion, "[" + label("a", R"(["walk"])", "") + "]", false)}, "tr\xFFn.json");
    run();
    EXPECT_EQ(Dataset(dir / "out").split("tr\\xFFn").size(), 1U);
}

TEST_F(BabelOnDevice, CutsClipsOutOfARecording) {
    write_amass(dir / "raw/CMU/01/01_01_poses.npz", {});
    write_amass(dir / "raw/CMU/01/01_02_poses.npz", {});
    // Labels overlap, are not sorted, and one has two classes; the second sequence has a label of all of it.
    annotate({sequence(7, motion,
                       "[" + label("b", R"(["run", "walk", "run"])", R"(, "start_t": 0.5, "end_t": 0.9)") +
                           ", " + label("a", R"(["walk"])", R"(, "start_t": 0, "end_t": 0.6)") + "]")});
    annotate({sequence(8, "CMU/CMU/01/01_02_poses.npz", "[" + label("c", R"(["jump"])", "") + "]", false)},
             "val.json");
    options.categories = "walk,run,jump";
    const auto summary = run();
    EXPECT_TRUE(summary.left_out.empty());
    EXPECT_TRUE(summary.doubts.empty());
    const Dataset dataset(dir / "out");
    EXPECT_EQ(dataset.header().origin.text(), "recorded, generic skeleton, 3 categories");
    EXPECT_EQ(dataset.header().classes, (std::vector<std::string>{"walk", "run", "jump"}));
    std::map<std::string, std::size_t> clips;
    for (std::size_t i = 0; i < dataset.clips().size(); ++i) clips[dataset.clips()[i].name] = i;
    ASSERT_EQ(clips.size(), 4U);
    EXPECT_EQ(dataset.split("train").size(), 3U);
    EXPECT_EQ(dataset.split("val"), std::vector<std::size_t>{clips.at("c_l00_A003")});
    const auto& run_clip = dataset.clips()[clips.at("b_l00_A002")];
    EXPECT_EQ(run_clip.label, 1U);
    EXPECT_EQ(run_clip.fields, (std::vector<std::string>{"train", "CMU", "01", "7", "does b"}));
    EXPECT_EQ(dataset.motion(clips.at("b_l00_A001")).values, dataset.motion(clips.at("b_l00_A002")).values);
    // Frames 15 to 26 of 31: int(0.5 * 30) to int(0.9 * 30). The knee turns at half a radian a second.
    for (const auto& [name, first, frames] :
         {std::tuple{"b_l00_A002", 15, 12U}, std::tuple{"a_l01_A001", 0, 18U},
          std::tuple{"c_l00_A003", 0, 31U}}) {
        const auto clip = dataset.motion(clips.at(name));
        ASSERT_EQ(clip.frames, frames) << name;
        for (std::uint32_t t = 0; t < frames; ++t) {
            const double angle = 0.5 * (first + static_cast<int>(t)) / 30,
                         middle = 0.5 * (first + (frames - 1) / 2.0) / 30;
            const float *root = clip.at(t, 0, 0), *knee = clip.at(t, 0, 4), *place = clip.at(t, 0, 24);
            // z up has become y up: the root's first row stays, its second is what the third was.
            const float upright[6] = {1, 0, 0, 0, 0, 1};
            for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(root[i], upright[i], 1e-7);
            EXPECT_NEAR(knee[4], std::cos(angle), 1e-7);
            EXPECT_NEAR(knee[5], -std::sin(angle), 1e-7);
            EXPECT_NEAR(place[0], angle - middle, 1e-7);
            EXPECT_NEAR(place[1], 0, 1e-7);
            EXPECT_NEAR(place[2], 0, 1e-7);
        }
    }
}

TEST_F(BabelOnDevice, ABodyModelGivesTheRestSkeleton) {
    write_amass(dir / "raw/CMU/01/01_01_poses.npz", {});
    annotate({sequence(7, motion, "[" + label("a", R"(["walk"])", R"(, "start_t": 0, "end_t": 1)") + "]")});
    auto body = made_body();
    for (auto& v : body["v_template"].values) v *= 1.5;
    write_body(dir / "large.npz", body);
    options.categories = "walk";
    options.rotational.body = (dir / "large.npz").string();
    run();
    const Dataset dataset(dir / "out");
    EXPECT_EQ(dataset.header().origin.text(), "recorded, skeleton of large.npz, 1 category");
    const auto generic = generic_skeleton().rest(), got = dataset.header().rest;
    ASSERT_EQ(got.size(), generic.size());
    for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], 1.5F * generic[i], 1e-6);
    // The body lies, as rotations of 0 have it where z is up: its thigh points along +z.
    const auto joints = joint_positions(dataset.motion(0), dataset.body(0));
    EXPECT_NEAR(joints[3 * 1 + 2] - joints[3 * 4 + 2], 1.5 * generic[3 * 4 + 1], 1e-5);
    options.rotational.body = (dir / "none.pkl").string();
    EXPECT_NE(fault().find("none.pkl"), std::string::npos) << fault();
}

TEST_F(BabelOnDevice, CountsAndNamesWhatGivesNoClip) {
    write_amass(dir / "raw/CMU/01/01_01_poses.npz", {});
    write_amass(dir / "raw/CMU/01/01_02_poses.npz", {});  // of no sequence
    write_file(dir / "raw/CMU/01/shape.npz", "no archive at all");
    annotate(
        {sequence(1, motion,
                  "[" + label("past", R"(["walk"])", R"(, "start_t": 0.5, "end_t": 99)") + ", " +
                      label("empty", R"(["walk"])", R"(, "start_t": 0.5, "end_t": 0.51)") + ", " +
                      label("behind", R"(["walk"])", R"(, "start_t": 50, "end_t": 60)") + ", " +
                      label("null", "null", R"(, "start_t": 0, "end_t": 1)") + ", " +
                      label("other", R"(["transition", "Walk"])", R"(, "start_t": 0, "end_t": 1)") + "]"),
         sequence(2, "KIT/KIT/3/walk_poses.npz", "[]"), sequence(3, motion, "null"),
         R"("4": {"feat_p": "CMU/CMU/01/01_01_poses.npz", "frame_ann": {"labels": [{"start_t": "soon"}]}})",
         R"("5": {"feat_p": null})"});
    write_file(dir / "raw/extra_train.json",
               R"({"1": {"feat_p": "a/b/c/d_poses.npz", "seq_anns": [], "frame_anns": null}})");
    write_file(dir / "raw/action_label_2_idx.json", R"({"walk": 0})");
    write_file(dir / "raw/val.json", "<!DOCTYPE html><html>quota exceeded</html>");
    write_file(dir / "raw/cut.json", R"({"1": {"feat_p": )");
    options.categories = "walk";
    const auto summary = run();
    EXPECT_EQ(Dataset(dir / "out").clips().size(), 1U);
    EXPECT_EQ(left_out("missing"), std::vector<std::string>{"sequence 2: no file KIT/KIT/3/walk_poses.npz"});
    const auto dropped = left_out("dropped");
    const std::vector<std::string> wanted{
        "label 1 of sequence 1 ('does empty'): no frame from 0.5 s to 0.51 s",
        "label 2 of sequence 1 ('does behind'): no frame from 50 s to 60 s",
        "label 3 of sequence 1 ('does null'): no category",
        "label 4 of sequence 1 ('does other'): 'transition' is none of the classes",
        "label 4 of sequence 1 ('does other'): 'Walk' is none of the classes",
        "sequence 3: no labels",
        "the annotations have no sequence of it",
        "holds no motion",
        "JSON, but no annotations of BABEL: no sequence has a 'feat_p'"};
    for (const auto& reason : wanted) EXPECT_TRUE(any_has(dropped, reason)) << reason;
    EXPECT_EQ(dropped.size(), wanted.size());
    const auto broken = left_out("broken");
    ASSERT_EQ(broken.size(), 4U);
    EXPECT_TRUE(any_has(broken, "an HTML page in place of annotations"));
    EXPECT_TRUE(any_has(broken, "sequence 4: label 0: 'start_t' is no number of seconds"));
    EXPECT_TRUE(any_has(broken, "sequence 5: 'feat_p' is no text"));
    EXPECT_TRUE(any_has(broken, "no JSON: "));
    ASSERT_EQ(summary.doubts.size(), 1U);
    EXPECT_EQ(summary.doubts[0].what, "the label ends behind the motion: cut off there");
    EXPECT_TRUE(any_has(summary.remarks, "1 of 3 sequences have no file here: KIT/KIT/3/walk_poses.npz"));
    EXPECT_TRUE(any_has(summary.remarks, "labels of categories that are no classes: Walk 1, transition 1"));
    EXPECT_TRUE(any_has(summary.remarks, "labels without a category: 1"));
    EXPECT_TRUE(any_has(summary.remarks, "labels are those of several annotators: extra_train.json"));
}

TEST_F(BabelOnDevice, FilesInFoldersOfNoSubsetAreTakenAndTold) {
    write_amass(dir / "raw/other/01/01_01_poses.npz", {});
    write_amass(dir / "raw/CMU/01/01_02_poses.npz", {});
    annotate({sequence(1, motion, "[" + label("a", R"(["walk"])", "") + "]", false),
              sequence(2, "CMU/CMU/01/01_02_poses.npz", "[" + label("b", R"(["walk"])", "") + "]", false)});
    EXPECT_TRUE(any_has(run().remarks,
                        "1 file is matched by subject and trial alone (01/01_01_poses.npz): its folders name "
                        "no subset of AMASS"));
    EXPECT_EQ(Dataset(dir / "out").clips().size(), 2U);
    fs::remove_all(dir / "out");
    fs::rename(dir / "raw/other", dir / "raw/cmu");
    EXPECT_FALSE(any_has(run().remarks, "subject and trial alone"));
}

TEST_F(BabelOnDevice, TellsThePackagesApart) {
    write_amass(dir / "raw/CMU/01/01_01_stageii.npz", {.numbers = 165, .rate = "mocap_frame_rate"});
    write_amass(dir / "raw/CMU/01/01_02_stageii.npz", {.numbers = 165, .rate = ""});
    write_amass(dir / "raw/CMU/01/01_03_poses.npz", {.rate = ""});
    write_amass(dir / "raw/CMU/01/01_04_poses.npz", {.numbers = 147});
    write_amass(dir / "raw/CMU/01/01_05_poses.npz", {.frames = 61, .fps = 59.9999885559082});
    write_amass(dir / "raw/CMU/01/01_06_poses.npz", {.fps = 0});
    write_amass(dir / "raw/CMU/01/01_07_poses.npz", {.frames = 0});
    write_amass(dir / "raw/CMU/01/01_08_poses.npz", {});
    auto cut_short = read_file(dir / "raw/CMU/01/01_08_poses.npz");
    write_file(dir / "raw/CMU/01/01_08_poses.npz", cut_short.substr(0, cut_short.size() / 2));
    std::vector<std::string> sequences;
    for (int i = 1; i <= 8; ++i)
        sequences.push_back(sequence(i, fmt::format("CMU/CMU/01/01_{:02}_poses.npz", i),
                                     "[" + label(std::to_string(i), R"(["walk"])", "") + "]", false));
    annotate(sequences);
    const auto summary = run();
    const Dataset dataset(dir / "out");
    ASSERT_EQ(dataset.clips().size(), 2U);
    EXPECT_EQ(dataset.clips()[0].name, "1_l00_A001");
    EXPECT_EQ(dataset.clips()[1].name, "5_l00_A001");
    EXPECT_EQ(dataset.clips()[1].frames,
              31U);  // 59.9999885 is not taken for 60, and its last frame is not lost
    ASSERT_EQ(summary.doubts.size(), 1U);
    EXPECT_EQ(summary.doubts[0].clips, 1U);
    EXPECT_TRUE(summary.doubts[0].what.starts_with("this is the SMPL-X package")) << summary.doubts[0].what;
    const auto broken = left_out("broken");
    ASSERT_EQ(broken.size(), 6U) << fmt::format("{}", fmt::join(broken, "\n"));
    EXPECT_TRUE(any_has(broken, "SMPL+H G (this is the SMPL-X package; take SMPL+H G)"));
    EXPECT_TRUE(any_has(broken, "no 'mocap_framerate' in it"));
    EXPECT_TRUE(any_has(broken, "'poses': (121, 147) of type <f8"));
    EXPECT_TRUE(any_has(broken, "'mocap_framerate': 0, no number of frames a second"));
    EXPECT_TRUE(any_has(broken, "'poses' has no frames")) << fmt::format("{}", fmt::join(broken, "\n"));
}

TEST_F(BabelOnDevice, PublishedResamplingPinsTheEndsAndLeavesZUp) {
    write_amass(dir / "raw/CMU/01/01_01_poses.npz", {.frames = 122});
    annotate({sequence(1, motion, "[" + label("a", R"(["walk"])", "") + "]", false)});
    options.published = true;
    run();
    const auto clip = Dataset(dir / "out").motion(0);
    ASSERT_EQ(clip.frames, 30U);  // round(122 / 4) is 30, half to even: so the rate is 29 frames in 121/120 s
    for (std::uint32_t t = 0; t < 30; ++t) {
        const double at = 0.5 * t * (121.0 / 29) / 120;
        // A line is not its own spline where the ends mirror it, so that the slope there would be 0.
        EXPECT_NEAR(clip.at(t, 0, 4)[5], -std::sin(at), 1e-5);
        EXPECT_NEAR(clip.at(t, 0, 24)[0], at - 0.5 * 121 / 240, 1e-5);
        EXPECT_NEAR(clip.at(t, 0, 0)[4], 1, 1e-6);
    }
}

TEST_F(BabelOnDevice, SaysWhatIsNotAmongTheFiles) {
    write_amass(dir / "raw/CMU/01/01_01_poses.npz", {});
    EXPECT_TRUE(fault().starts_with("no annotations of BABEL among the files: give train.json")) << fault();
    annotate({sequence(1, "KIT/KIT/3/walk_poses.npz", "[]")});
    EXPECT_TRUE(fault().starts_with(
        "none of 1 files holds the motion of one of BABEL's 1 sequences, as in KIT/KIT/3/walk"))
        << fault();
    options.fps = 0;
    EXPECT_TRUE(fault().starts_with("0 frames a second")) << fault();
}

TEST_F(BabelOnDevice, AgreesWithNumPyAndSciPyOnRealMotion) {
    const auto archive = shared("data/cmu_amass/CMU.tar.xz"), labels = shared("data/cmu_amass/babel_like");
    if (!fs::exists(archive)) GTEST_SKIP() << archive << " is not at hand";
    if (!python_has("h5py, scipy")) GTEST_SKIP() << "NumPy, SciPy or h5py is not at hand";
    ASSERT_EQ(run_command("mkdir " + (dir / "amass").string() + " && tar -xJf " + archive + " -C " +
                          (dir / "amass").string())
                  .exit,
              0);
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(dir / "amass"))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (std::size_t i = 0; i < files.size(); ++i)
        if (i % 4 != 0) fs::remove(files[i]);  // all of them take SciPy a while
    const auto make = [&](const char* name) {
        IngestRequest request;
        request.raw = {dir / "amass", labels};
        request.out = dir / name;
        request.one_dataset = true;
        BabelFormat format(options);
        ingest::ingest(request, format, device);
        return (dir / name).string();
    };
    options.categories = "walk,run,dance,climb,jump,kick,transition,grasp object";
    auto line = "/usr/bin/python3 " + source("tests/ingest/formats/babel/babel_oracle.py") + " " +
                (dir / "amass").string() + " " + labels + " " + make("rotations");
    options.rotational.representation = "xyz";
    line += " " + make("places");
    options.rotational.representation = "rot6d";
    options.published = true;
    line += " " + make("published");
    const auto said = run_command(line);
    ASSERT_EQ(said.exit, 0) << said.output;
    std::istringstream lines(said.output);
    std::string name;
    std::size_t clips = 0, datasets = 0;
    for (double worst = 1; lines >> name >> clips >> worst; ++datasets) {
        EXPECT_GT(clips, 20U) << said.output;
        // float32 of numbers of some metres is exact to 5e-7; so are rotations that both compute in double precision.
        EXPECT_LT(worst, 1e-6) << said.output;
    }
    EXPECT_EQ(datasets, 3U) << said.output;
}
