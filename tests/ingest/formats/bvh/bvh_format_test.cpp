// BVH clips as a dataset: skeletons, labels, resampling, and what is refused.
#include "ingest/formats/bvh/bvh_format.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "ingest/formats/bvh/bvh_file.hpp"
#include "tests/support/collected.hpp"
#include "tests/support/replaced.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::ingest {
namespace {

using test::Collected;

using test::replaced;

using Names = std::vector<std::string>;

/// A floor joint that stands still, hips that travel along x, and a leg of two limbs with end sites.
const std::string walk =
    "HIERARCHY\nROOT Floor\n{\nOFFSET 0 0 0\nCHANNELS 4 Xposition Yposition Zposition Yrotation\n"
    "JOINT Hips\n{\nOFFSET 0 90 0\nCHANNELS 3 Xposition Yposition Zposition\n"
    "JOINT Knee\n{\nOFFSET 0 -40 0\nCHANNELS 1 Zrotation\n"
    "JOINT Foot\n{\nOFFSET 0 -50 0\nCHANNELS 0\n"
    "End Site\n{\nOFFSET 0 0 10\n}\nEnd Site\n{\nOFFSET 0 0 -10\n}\nEnd Site\n{\nOFFSET 0 0 "
    "0\n}\n}\n}\n}\n}\n"
    "MOTION\nFrames: 3\nFrame Time: 0.1\n"
    "0 0 0 90 10 90 0 0\n0 0 0 90 20 90 0 90\n0 0 0 90 30 90 0 90\n";

struct Text {
    explicit Text(const std::string& text) : padded(text + std::string(64, '\0')), size(text.size()) {}
    std::string_view view() const { return std::string_view(padded).substr(0, size); }
    std::string padded;
    std::size_t size;
};

Recording file_of(const std::string& text) {
    auto parsed = parse_bvh(Text(text).view());
    if (const auto* r = std::get_if<Rejection>(&parsed)) throw Error("{}", r->reason);
    return std::get<std::vector<Recording>>(std::move(parsed)).front();
}

BvhOptions options() {
    BvhOptions o;
    o.dataset = "walks";
    o.pattern = "{action}_{index}";
    return o;
}

/// Path and text of files, in the source's order.
using Files = std::vector<std::pair<std::string, std::string>>;

/// A path below /raw, as the pipeline has it.
struct RawFileText {
    RawFileText(const std::string& inside_, const std::string& text, std::uint64_t index_ = 0)
        : inside(inside_), path("/raw/" + inside_), padded(text), index(index_) {}
    RawText raw() const {
        const auto name = std::string_view(inside).substr(inside.find_last_of('/') + 1);
        return {path, name.substr(0, name.rfind('.')), padded.view(), inside, index};
    }
    std::string inside, path;
    Text padded;
    std::uint64_t index;
};

std::unique_ptr<BvhFormat> settled(const BvhOptions& o, const Files& files) {
    auto format = std::make_unique<BvhFormat>(o);
    for (std::size_t i = files.size(); i-- > 0;)
        format->survey(RawFileText(files[i].first, files[i].second, i).raw());
    format->settle();
    return format;
}

/// Of two files: a walk, and a run that is broken.
std::unique_ptr<BvhFormat> settled(const BvhOptions& o) {
    return settled(o, {{"walk_1.bvh", walk}, {"run_1.bvh", "HIERARCHY"}});
}

std::vector<ParsedClip> read(const BvhFormat& format, const std::string& path, const std::string& text) {
    Collected out;
    format.read(RawFileText(path, text).raw(), out);
    return std::move(out.clips);
}

std::string refusal(const BvhFormat& format, const std::string& text, const char* path = "walk_1.bvh") {
    const auto clips = read(format, path, text);
    if (clips.size() != 1) return fmt::format("{} clips", clips.size());
    return std::holds_alternative<Rejection>(clips[0]) ? std::get<Rejection>(clips[0]).reason : "taken";
}

std::vector<std::unique_ptr<RawClip>> taken(std::vector<ParsedClip> parsed) {
    std::vector<std::unique_ptr<RawClip>> out;
    for (auto& clip : parsed) {
        if (auto* r = std::get_if<Rejection>(&clip)) throw Error("{}", r->reason);
        out.push_back(std::get<std::unique_ptr<RawClip>>(std::move(clip)));
    }
    return out;
}

template <typename Call>
std::string error_of(const Call& call) {
    try {
        call();
    } catch (const Error& e) {
        return e.what();
    }
    return "none";
}

kernels::CleanedBatch cleaned(const BvhFormat& format, const Files& files,
                              std::vector<std::uint32_t>& frames) {
    std::vector<std::unique_ptr<RawClip>> clips;
    for (const auto& [path, text] : files)
        for (auto& clip : taken(read(format, path, text))) clips.push_back(std::move(clip));
    kernels::Device device;
    return format.clean(device, 0, clips, frames);
}

/// Of one file, which alone decides.
kernels::CleanedBatch cleaned(const BvhOptions& o, const std::string& text) {
    std::vector<std::uint32_t> frames;
    return cleaned(*settled(o, {{"walk_1.bvh", text}}), {{"walk_1.bvh", text}}, frames);
}

void expect_near(std::span<const float> got, const std::vector<double>& want) {
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(got[i], want[i], 1e-5) << i;
}

double unit(double length) {
    return length / (std::abs(length) + 1e-4);
}

TEST(BvhSkeleton, TheRootIsTheFirstJointThatTravels) {
    EXPECT_EQ(automatic_root(file_of(walk)), 1U);
    // Both move, neither does, and the floor joint has two children.
    EXPECT_EQ(automatic_root(file_of(replaced(walk, "0 0 0 90 20", "0 1 0 90 20"))), 0U);
    EXPECT_EQ(automatic_root(file_of(replaced(replaced(walk, "90 20", "90 10"), "90 30", "90 10"))), 0U);
    EXPECT_EQ(automatic_root(file_of(
                  replaced(walk, "}\n}\n}\nMOTION", "}\n}\nJOINT Prop\n{\nOFFSET 0 0 0\n}\n}\nMOTION"))),
              0U);
}

TEST(BvhSkeleton, EndSitesBecomeJointsWhereWanted) {
    const auto file = file_of(walk);
    EXPECT_EQ(skeleton_below(file, 1, false).topology, (Topology{{"Hips", "Knee", "Foot"}, {-1, 0, 1}}));
    EXPECT_EQ(skeleton_below(file, 2, true).topology,
              (Topology{{"Knee", "Foot", "Foot end", "Foot end 2"}, {-1, 0, 1, 1}}));
    // A joint's own name comes first, wherever it stands.
    const auto later = file_of(
        replaced(walk, "OFFSET 0 0 0\n}\n}", "OFFSET 0 0 0\n}\nJOINT Foot end\n{\nOFFSET 1 0 0\n}\n}"));
    EXPECT_EQ(skeleton_below(later, 3, true).topology.names,
              (Names{"Foot", "Foot end 2", "Foot end 3", "Foot end"}));
    EXPECT_EQ(find_joint(file, "Foot"), 3);
    EXPECT_EQ(find_joint(file, ""), -1);
}

TEST(BvhFormat, SaysWhatTheDatasetIs) {
    auto o = options();
    o.splits = {{"first/train", {{"index", {"1"}, false}}}};
    const auto settled_format = settled(o);
    const auto& format = *settled_format;
    ASSERT_EQ(format.datasets().size(), 1U);
    const auto& header = format.datasets()[0];
    EXPECT_EQ(header.name, "walks");
    EXPECT_EQ(header.persons, 1U);
    EXPECT_EQ(header.fps, 10);
    EXPECT_EQ(header.topology, (Topology{{"Hips", "Knee", "Foot"}, {-1, 0, 1}}));
    EXPECT_EQ(header.classes, (Names{"run", "walk"}));
    EXPECT_EQ(header.fields, (Names{"action", "index"}));
    EXPECT_EQ(header.splits.size(), 1U);
}

TEST(BvhFormat, ParsesClipsWithLabelsAndFields) {
    const auto clips = taken(read(*settled(options()), "walk_07.bvh", walk));
    ASSERT_EQ(clips.size(), 1U);
    EXPECT_EQ(clips[0]->name, "walk_07");
    EXPECT_EQ(clips[0]->label, 1U);
    EXPECT_EQ(clips[0]->fields, (Names{"walk", "07"}));
}

TEST(BvhFormat, CleansOnTheDevice) {
    std::vector<std::uint32_t> frames;
    const auto out = cleaned(*settled(options()), {{"walk_1.bvh", walk}}, frames);
    EXPECT_EQ(frames, std::vector<std::uint32_t>{3});
    // The floor turns by a right angle about y: x becomes -z. The knee then turns the foot from -y to x,
    // there -z.
    const double thigh = unit(-0.4), shin = unit(-0.5);
    expect_near(out.motion, {0, 0, 0.1,  0, thigh, 0, 0, shin, 0,     //
                             0, 0, 0,    0, thigh, 0, 0, 0,    shin,  //
                             0, 0, -0.1, 0, thigh, 0, 0, 0,    shin});
    expect_near(out.bone_length, {0, 0.4, 0.5});
}

TEST(BvhFormat, ResamplesToOneRate) {
    auto o = options();
    o.fps = 20;
    std::vector<std::uint32_t> frames;
    const auto half = replaced(walk, "Frame Time: 0.1", "Frame Time: 0.05");
    const auto out = cleaned(*settled(o), {{"walk_1.bvh", walk}, {"walk_2.bvh", half}}, frames);
    EXPECT_EQ(frames, (std::vector<std::uint32_t>{5, 3}));
    for (int t = 0; t < 5; ++t) EXPECT_NEAR(out.motion[t * 9 + 2], 0.1 - 0.05 * t, 1e-6) << t;
    o.fps = 4;  // fewer than recorded: frames 0 and 2.5, of which the second lies past the end
    cleaned(*settled(o), {{"walk_1.bvh", walk}}, frames);
    EXPECT_EQ(frames, (std::vector<std::uint32_t>{1}));
    o.fps = 20;
    o.recorded_fps = 20;  // the files say 10, and are wrong
    cleaned(*settled(o), {{"walk_1.bvh", walk}}, frames);
    EXPECT_EQ(frames, (std::vector<std::uint32_t>{3}));
}

TEST(BvhFormat, TakesOtherOffsetsAndChannelOrders) {
    const auto format = settled(options());
    EXPECT_EQ(refusal(*format, replaced(walk, "OFFSET 0 -40 0", "OFFSET 0 -41 0")), "taken");
    EXPECT_EQ(refusal(*format, replaced(walk, "Zrotation", "Xrotation")), "taken");
}

TEST(BvhFormat, TheCommonestSkeletonSaysWhichEndSitesThereAre) {
    auto o = options();
    const auto more = replaced(walk, "OFFSET 0 0 0\n}\n}", "OFFSET 0 0 5\n}\n}"),
               fewer = replaced(walk, "0 0 10", "0 0 0");
    EXPECT_EQ(refusal(*settled(o), more), "taken");
    EXPECT_EQ(refusal(*settled(o), fewer), "taken");
    o.end_sites = true;
    EXPECT_EQ(refusal(*settled(o), more), "taken");
    EXPECT_EQ(refusal(*settled(o), fewer),
              "another skeleton than that of most files: joint 'Foot end' is missing");
}

TEST(BvhFormat, KeepsToTheClassesListed) {
    auto o = options();
    EXPECT_TRUE(settled(o)->drops_empty_classes());
    o.classes = {"walk", "jump"};
    const auto format = settled(o);
    EXPECT_EQ(format->datasets()[0].classes, (Names{"walk", "jump"}));
    EXPECT_FALSE(format->drops_empty_classes());
    EXPECT_EQ(refusal(*format, walk, "run_1.bvh"), "action 'run' is none of the classes");
    o.classes = {"jump"};
    EXPECT_EQ(error_of([&] { settled(o); }),
              "none of the classes jump is in a file name; the actions are run,walk");
    o.classes = {"walk", "walk"};
    EXPECT_EQ(error_of([&] { settled(o); }), "a class is listed twice: walk,walk");
}

TEST(BvhFormat, RefusesFilesThatDoNotBelong) {
    const auto format = settled(options());
    EXPECT_EQ(refusal(*format, walk, "walk.bvh"), "the name does not fit the pattern '{action}_{index}'");
    EXPECT_EQ(refusal(*format, "HIERARCHY"), "line 1: the end of the text in place of ROOT");
    EXPECT_EQ(refusal(*format, replaced(walk, "Hips", "Pelvis")),
              "another skeleton than that of most files: no joint 'Hips', the root");
    EXPECT_EQ(refusal(*format, replaced(walk, "Foot", "Toe")),
              "another skeleton than that of most files: joint 'Foot' is missing");
    EXPECT_EQ(refusal(*format, replaced(walk, "Frame Time: 0.1", "Frame Time: 0.05")),
              "20 frames a second, not 10 as in most files; --fps resamples all to one rate");
    EXPECT_EQ(error_of([] {
                  settled(options(), {{"run_1.bvh", "HIERARCHY"}});
              }),
              "no BVH file is sound; the first fault is in /raw/run_1.bvh: line 1: the end of the text in "
              "place of ROOT");
}

/// The knee's positions in place of its turn: as they come, near 0, or as long as the OFFSET.
std::string with_knee_positions(const std::string& position) {
    auto text = replaced(walk, "CHANNELS 1 Zrotation", "CHANNELS 3 Xposition Yposition Zposition");
    for (const char* line : {"10 90 0 0\n", "20 90 0 90\n", "30 90 0 90\n"})
        text = replaced(text, line, std::string(line).substr(0, 8) + position + "\n");
    return text;
}

TEST(BvhFormat, PositionsThatDoNotReplaceOffsetsAreRefused) {
    auto o = options();
    const char* why =
        "the position channels of Knee are near 0, where their OFFSETs are not; --positions add adds the "
        "two, and --positions ignore "
        "leaves the channels out";
    EXPECT_EQ(refusal(*settled(o), with_knee_positions(" 0 0 0")), why);
    EXPECT_EQ(refusal(*settled(o), with_knee_positions(" 0.00001 1 -0.00002")), why);
    EXPECT_EQ(refusal(*settled(o), with_knee_positions(" 0 -39 0")), "taken");
    EXPECT_NEAR(cleaned(o, with_knee_positions(" 0 -39 0")).bone_length[1], 0.39, 1e-6);
    for (const auto& [how, length] : {std::pair{"replace", 0.01}, {"add", 0.39}, {"ignore", 0.4}}) {
        o.positions = how;
        EXPECT_NEAR(cleaned(o, with_knee_positions(" 0 1 0")).bone_length[1], length, 1e-6) << how;
    }
}

TEST(BvhFormat, RefusesOptionsThatMakeNoSense) {
    const auto why = [](auto change) {
        auto o = options();
        change(o);
        return error_of([&] { settled(o); });
    };
    EXPECT_EQ(why([](BvhOptions& o) { o.scale = "0"; }),
              "scale 0 is not a number of metres a unit; centimetres are 0.01, and auto finds out");
    EXPECT_EQ(why([](BvhOptions& o) { o.scale = "1cm"; }),
              "scale 1cm is not a number of metres a unit; centimetres are 0.01, and auto finds out");
    EXPECT_EQ(why([](BvhOptions& o) { o.fps = -1; }),
              "-1 frames a second cannot be resampled to; give 1 to 1000, or 0 for as recorded");
    EXPECT_EQ(why([](BvhOptions& o) { o.recorded_fps = 0.1; }),
              "0.1 frames a second cannot be what was recorded; give 1 to 1000, or 0 for as recorded");
    EXPECT_EQ(why([](BvhOptions& o) { o.smooth = -1; }),
              "smoothing over -1 frames makes no sense; give 0 for none, or up to 1000");
    EXPECT_EQ(why([](BvhOptions& o) { o.root = "Head"; }),
              "no joint 'Head' to take as root; the joints are Floor, Hips, Knee, Foot");
    EXPECT_EQ(why([](BvhOptions& o) { o.up = "w"; }),
              "'w' is no axis that points up; give y, z, -y, -z, x or -x");
    EXPECT_EQ(why([](BvhOptions& o) { o.positions = "told"; }),
              "'told' is nothing to do with positions; give replace, add or ignore");
    EXPECT_EQ(why([](BvhOptions& o) { o.start = "1.5"; }),
              "--start '1.5' is no place in a clip; give frames, as in 30, or seconds, as in 1.5s");
    EXPECT_EQ(why([](BvhOptions& o) { o.end = "-1s"; }),
              "--end '-1s' is no place in a clip; give frames, as in 30, or seconds, as in 1.5s");
    EXPECT_EQ(why([](BvhOptions& o) { o.start = o.end = "2s"; }), "--end 2s is not after --start 2s");
    EXPECT_EQ(why([](BvhOptions& o) { o.end = "0"; }), "--end 0 is not after --start 0");
    EXPECT_EQ(why([](BvhOptions& o) { o.persons = 101; }), "101 persons a clip are too many; give 1 to 100");
    EXPECT_EQ(why([](BvhOptions& o) {
                  o.splits = {{"a/train", {{"stile", {"x"}, false}}}};
              }),
              "split a/train: clips have no field 'stile'; they have action, index");
    EXPECT_EQ(why([](BvhOptions& o) { o.pattern = "{action}+{n}"; }),
              "no file name fits the pattern '{action}+{n}'; there is 'walk_1'");
}

TEST(BvhFormat, EveryOptionShowsInTheSettings) {
    const auto settings = [](auto change) {
        auto o = options();
        change(o);
        return settled(o)->settings();
    };
    const auto plain = settings([](BvhOptions&) {});
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.scale = "1"; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.scale = "auto"; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.up = "z"; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.positions = "replace"; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.fps = 5; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.recorded_fps = 10; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.skip_first = 1; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.start = "1"; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.end = "0.2s"; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.persons = 2; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.smooth = 1; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.end_sites = true; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.root = "Knee"; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.centre_windows = true; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.classes = {"walk"}; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.pattern = "{action}_{n}"; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.splits = {{"a", {{"index", {"1"}, false}}}}; }));
}

/// A person 170 units tall in rest, standing along `up`, who walks along x for three frames.
std::string person(const std::string& up = "y", double scale = 1, const std::string& frame_zero = "") {
    const auto along = [&](double length) {
        const double v = (up[0] == '-' ? -length : length) * scale;
        const char axis = up.back();
        return fmt::format("{} {} {}", axis == 'x' ? v : 0, axis == 'y' ? v : 0, axis == 'z' ? v : 0);
    };
    std::string text = fmt::format(
        "HIERARCHY\nROOT Hips\n{{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\nJOINT "
        "Spine\n{{\nOFFSET {}\n"
        "CHANNELS 1 Zrotation\nEnd Site\n{{\nOFFSET {}\n}}\n}}\nJOINT LeftLeg\n{{\nOFFSET {}\nCHANNELS 1 "
        "Xrotation\nEnd "
        "Site\n{{\nOFFSET {}\n}}\n}}\n}}\nMOTION\nFrames: {}\nFrame Time: 0.1\n{}",
        along(50), along(30), along(-50), along(-40), frame_zero.empty() ? 3 : 4, frame_zero);
    for (int f = 0; f < 3; ++f) text += fmt::format("{} 0 0 0 {}\n", f * scale, f);
    return text;
}

bool says(const Names& lines, const std::string& words) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const auto& line) { return line.find(words) != std::string::npos; });
}

TEST(BvhSurvey, AReferencePoseDecidesNeitherRootNorSkeleton) {
    const auto pose =
        replaced(replaced(walk, "Frames: 3", "Frames: 1"), "0 0 0 90 20 90 0 90\n0 0 0 90 30 90 0 90\n", "");
    const auto format = settled(options(), {{"tpose_0.bvh", pose}, {"walk_1.bvh", walk}});
    EXPECT_EQ(format->datasets()[0].topology.names[0], "Hips");
    EXPECT_TRUE(says(format->remarks(), "root 'Hips' below 'Floor', 3 joints"));
    // Where the floor moves in one file and the hips in another, nothing is lost below the floor.
    const auto carried = replaced(replaced(walk, "0 0 0 90 20", "5 0 0 90 20"), "0 0 0 90 30", "9 0 0 90 30");
    EXPECT_EQ(
        settled(options(), {{"walk_0.bvh", carried}, {"walk_1.bvh", walk}})->datasets()[0].topology.names[0],
        "Hips");
    EXPECT_EQ(taken(read(*format, "tpose_0.bvh", pose))[0]->doubts, Names{"a single frame holds no motion"});
}

TEST(BvhSurvey, OfTheFilesWantedTheCommonestSkeletonWins) {
    const auto other = replaced(replaced(walk, "Foot", "Toe"), "Knee", "Shin");
    const Files files{{"calibration_1.bvh", other},
                      {"calibration_2.bvh", other},
                      {"run_1.bvh", walk},
                      {"walk_2.bvh", walk},
                      {"walk_3.bvh", walk}};
    auto o = options();
    const auto all = settled(o, files);
    EXPECT_EQ(all->datasets()[0].topology.names, (Names{"Hips", "Knee", "Foot"}));
    EXPECT_TRUE(
        says(all->remarks(),
             "left out for another skeleton than that of 3 files: 2 files (calibration_1, calibration_2)"));
    o.classes = {"walk"};
    const auto some = settled(o, {files[0], files[1], files[3]});
    EXPECT_EQ(some->datasets()[0].topology.names, (Names{"Hips", "Knee", "Foot"}));
    EXPECT_FALSE(says(some->remarks(), "left out"));
}

TEST(BvhSurvey, JointsAreMatchedByName) {
    // The spine comes after the leg, and its numbers after the leg's.
    auto other = person();
    const auto spine = other.find("JOINT Spine"), leg = other.find("JOINT LeftLeg"),
               end = other.find("}\nMOTION");
    other = other.substr(0, spine) + other.substr(leg, end - leg) + other.substr(spine, leg - spine) +
            other.substr(end);
    for (int f = 0; f < 3; ++f)
        other = replaced(other, fmt::format("{} 0 0 0 {}\n", f, f), fmt::format("{} 0 0 {} 0\n", f, f));
    const Files files{{"walk_1.bvh", person()}, {"walk_2.bvh", other}};
    std::vector<std::uint32_t> frames;
    const auto format = settled(options(), files);
    const auto out = cleaned(*format, files, frames);
    ASSERT_EQ(frames, (std::vector<std::uint32_t>{3, 3}));
    const auto half = out.motion.size() / 2;
    for (std::size_t i = 0; i < half; ++i) EXPECT_EQ(out.motion[i], out.motion[half + i]) << i;
}

TEST(BvhSurvey, ClipsAreToldApartByPath) {
    auto o = options();
    o.pattern = "{action}/{index}";
    const Files files{{"run/1.bvh", walk}, {"walk/1.bvh", walk}};
    const auto format = settled(o, files);
    EXPECT_EQ(format->datasets()[0].classes, (Names{"run", "walk"}));
    EXPECT_EQ(taken(read(*format, "run/1.bvh", walk))[0]->name, "run_1");
    EXPECT_EQ(taken(read(*format, "walk/1.bvh", walk))[0]->name, "walk_1");
}

TEST(BvhSurvey, AHeightThatNoPersonHasIsSaid) {
    auto o = options();
    EXPECT_FALSE(says(settled(o, {{"walk_1.bvh", person()}})->remarks(), "tall"));
    const auto metres = settled(o, {{"walk_1.bvh", person("y", 0.01)}});
    EXPECT_TRUE(says(metres->remarks(),
                     "a body is about 1.7 cm tall at 0.01 metres a unit; --scale 1 would make it 1.70 m, and "
                     "--scale auto finds that"))
        << fmt::format("{}", fmt::join(metres->remarks(), "\n"));
    o.scale = "auto";
    EXPECT_TRUE(says(settled(o, {{"walk_1.bvh", person("y", 0.01)}})->remarks(),
                     "scale 1: a body is about 1.70 m tall"));
    EXPECT_NEAR(cleaned(o, person("y", 0.01)).bone_length[1], 0.5, 1e-6);
    EXPECT_NEAR(cleaned(o, person("y", 10)).bone_length[1], 0.5, 1e-6);
    // One file in other units than the rest.
    EXPECT_TRUE(says(
        settled(o, {{"walk_1.bvh", person()}, {"walk_2.bvh", person()}, {"walk_3.bvh", person("y", 0.01)}})
            ->remarks(),
        "1 file of bodies more than 2.2 times as large or as small as most (walk_3)"));
}

TEST(BvhSurvey, ABodyThatLiesOrStandsOnItsHeadIsSaidAndTurned) {
    for (const auto& [up, how] : {std::pair{"z", "lie on their sides"},
                                  {"-z", "lie on their sides"},
                                  {"-x", "lie on their sides"},
                                  {"-y", "stand on their heads"}}) {
        SCOPED_TRACE(up);
        auto o = options();
        const Files files{{"walk_1.bvh", person(up)}};
        const auto lying = settled(o, files);
        EXPECT_TRUE(says(lying->remarks(), how)) << fmt::format("{}", fmt::join(lying->remarks(), "\n"));
        EXPECT_TRUE(says(lying->remarks(), fmt::format("--up {} turns them", up)));
        EXPECT_FALSE(says(lying->remarks(), "tall"));  // its height is measured along its length
        o.up = up;
        const auto standing = settled(o, files);
        EXPECT_FALSE(says(standing->remarks(), "--up"))
            << fmt::format("{}", fmt::join(standing->remarks(), "\n"));
        std::vector<std::uint32_t> frames;
        const auto out = cleaned(*standing, files, frames);
        EXPECT_NEAR(out.motion[4], unit(0.5), 1e-5);   // the spine, up
        EXPECT_NEAR(out.motion[7], unit(-0.5), 1e-5);  // the leg, down
    }
    auto o = options();
    EXPECT_FALSE(says(settled(o, {{"walk_1.bvh", person()}})->remarks(), "--up"));
}

TEST(BvhFormat, AFirstFrameThatJumpsIsSaidAndSkipped) {
    const auto text = person("y", 1, "-500 0 0 0 0\n");
    auto o = options();
    EXPECT_EQ(taken(read(*settled(o, {{"walk_1.bvh", text}}), "walk_1.bvh", text))[0]->doubts,
              Names{"the first frame is a jump, as from a reference pose; --skip-first 1 leaves it out"});
    o.skip_first = 1;
    const auto format = settled(o, {{"walk_1.bvh", text}});
    EXPECT_EQ(taken(read(*format, "walk_1.bvh", text))[0]->doubts, Names{});
    std::vector<std::uint32_t> frames;
    EXPECT_NEAR(cleaned(*format, {{"walk_1.bvh", text}}, frames).motion[0], -0.01, 1e-6);
    EXPECT_EQ(frames, std::vector<std::uint32_t>{3});
    o.skip_first = 4;
    EXPECT_EQ(refusal(*settled(o, {{"walk_1.bvh", text}}), text), "no frame is left of 4: from 4 to 4");
}

TEST(BvhFormat, AClipMayStartLaterAndEndEarlier) {
    const auto roots = [](const BvhOptions& o) {
        std::vector<std::uint32_t> frames;
        const auto out = cleaned(*settled(o, {{"walk_1.bvh", person()}}), {{"walk_1.bvh", person()}}, frames);
        return std::pair{frames[0], out.motion[0]};
    };
    auto o = options();
    EXPECT_EQ(roots(o).first, 3U);
    o.start = "1";
    EXPECT_EQ(roots(o).first, 2U);
    EXPECT_NEAR(roots(o).second, -0.005, 1e-6);
    o.start = "0.2s";
    EXPECT_EQ(roots(o).first, 1U);
    o.start = "";
    o.end = "2";
    EXPECT_EQ(roots(o).first, 2U);
    o.end = "0.1s";
    EXPECT_EQ(roots(o).first, 1U);
}

TEST(BvhFormat, WhatDoesNotMoveIsSaid) {
    auto still = person();
    for (int f = 1; f < 3; ++f) still = replaced(still, fmt::format("{} 0 0 0 {}\n", f, f), "0 0 0 0 0\n");
    EXPECT_EQ(taken(read(*settled(options(), {{"walk_1.bvh", still}}), "walk_1.bvh", still))[0]->doubts,
              Names{"nothing moves"});
}

/// Two persons in a file, whose roots are there along x.
std::string two_roots(const std::vector<std::pair<int, int>>& roots) {
    const auto one = person();
    const auto begin = one.find("ROOT"), end = one.find("MOTION");
    auto other = one.substr(begin, end - begin);
    for (const char* name : {"Hips", "Spine", "LeftLeg"})
        other = replaced(other, name, std::string(name) + "2");
    auto text = one.substr(0, end) + other;
    text += fmt::format("MOTION\nFrames: {}\nFrame Time: 0.1\n", roots.size());
    for (const auto& [first, second] : roots) text += fmt::format("{} 0 0 0 0 {} 0 0 0 0\n", first, second);
    return text;
}

TEST(BvhFormat, WhoOfSeveralPersonsDoesNotMoveIsSaid) {
    const auto both = two_roots({{0, 0}, {1, 1}, {2, 2}});
    const auto format = settled(options(), {{"walk_1.bvh", both}});
    const auto doubts = [&](const std::string& text) {
        return taken(read(*format, "walk_1.bvh", text))[0]->doubts;
    };
    EXPECT_EQ(doubts(both), Names{});
    EXPECT_EQ(doubts(two_roots({{0, 0}, {1, 0}, {2, 0}})), Names{"person 2 does not move"});
    EXPECT_EQ(doubts(two_roots({{5, 0}, {5, 1}, {5, 2}})), Names{"person 1 does not move"});
    EXPECT_EQ(doubts(two_roots({{5, 0}, {5, 0}, {5, 0}})), Names{"nothing moves"});
    EXPECT_EQ(doubts(two_roots({{5, 0}})), Names{"a single frame holds no motion"});
    EXPECT_EQ(doubts(two_roots({{0, -500}, {1, 0}, {2, 1}, {3, 2}})),
              Names{"the first frame is a jump, as from a reference pose; --skip-first 1 leaves it out"});
}

/// The roots of both persons of a clip of 3 frames and 3 joints, frame by frame.
std::vector<float> root_x(const kernels::CleanedBatch& out) {
    std::vector<float> x;
    for (std::size_t i = 0; i < out.motion.size(); i += 9) x.push_back(out.motion[i]);
    return x;
}

void expect_two_persons(const std::vector<float>& x) {
    // The second walks 2 m behind the first; the mean of both over the clip is the origin.
    ASSERT_EQ(x.size(), 6U);
    for (int f = 0; f < 3; ++f) {
        EXPECT_NEAR(x[2 * f], 1 - 0.01 + 0.01 * f, 1e-5) << f;
        EXPECT_NEAR(x[2 * f + 1], -1 - 0.01 + 0.01 * f, 1e-5) << f;
    }
}

/// The person 200 units further back.
std::string behind() {
    auto text = person();
    for (int f = 0; f < 3; ++f)
        text =
            replaced(text, fmt::format("\n{} 0 0 0 {}\n", f, f), fmt::format("\n{} 0 0 0 {}\n", f - 200, f));
    return text;
}

TEST(BvhFormat, TwoRootsAreTwoPersons) {
    auto text = person();
    auto second = behind();
    const auto hierarchy = [](const std::string& t) {
        return t.substr(t.find("ROOT"), t.find("MOTION") - t.find("ROOT"));
    };
    auto other = hierarchy(second);
    for (const char* name : {"Hips", "Spine", "LeftLeg"})
        other = replaced(other, name, std::string(name) + "2");
    text.insert(text.find("MOTION"), other);
    for (int f = 0; f < 3; ++f)
        text = replaced(text, fmt::format("\n{} 0 0 0 {}\n", f, f),
                        fmt::format("\n{} 0 0 0 {} {} 0 0 0 {}\n", f, f, f - 200, f));
    const auto format = settled(options(), {{"walk_1.bvh", text}});
    EXPECT_EQ(format->datasets()[0].persons, 2U);
    EXPECT_EQ(format->datasets()[0].topology.names, (Names{"Hips", "Spine", "LeftLeg"}));
    std::vector<std::uint32_t> frames;
    expect_two_persons(root_x(cleaned(*format, {{"walk_1.bvh", text}}, frames)));
    EXPECT_EQ(frames, std::vector<std::uint32_t>{3});
    EXPECT_EQ(refusal(*format, person()), "persons: 1, not 2; --persons 1 takes such clips");
    auto o = options();
    o.persons = 1;
    EXPECT_EQ(refusal(*settled(o, {{"walk_1.bvh", text}}), text),
              "persons: 2, not 1; --persons 2 takes such clips");
}

TEST(BvhFormat, FilesMayBePersonsOfOneClip) {
    const test::TempDir dir;
    const auto longer =
        replaced(behind(), "Frames: 3", "Frames: 4") + "-197 0 0 0 3\n";  // by the one frame that is allowed
    const Files files{{"walk_1_a.bvh", person()},
                      {"walk_1_b.bvh", longer},
                      {"walk_2_a.bvh", person()},
                      {"walk_2_b.bvh", behind() + ""},
                      {"walk_3_a.bvh", person()}};
    auto o = options();
    o.pattern = "{action}_{take}_{person}";
    BvhFormat format(o);
    const auto raw = [&](std::size_t i, const Text& text, std::string& path) -> RawText {
        path = (dir / files[i].first).string();
        return {path, std::string_view(files[i].first).substr(0, 8), text.view(), files[i].first, i};
    };
    std::string path;
    for (std::size_t i = 0; i < files.size(); ++i) {
        test::write_file(dir / files[i].first, files[i].second);
        format.survey(raw(i, Text(files[i].second), path));
    }
    format.settle();
    EXPECT_EQ(format.datasets()[0].persons, 2U);
    EXPECT_EQ(format.datasets()[0].fields, (Names{"action", "take"}));
    Collected out;
    for (std::size_t i = 0; i < files.size(); ++i) format.read(raw(i, Text(files[i].second), path), out);
    ASSERT_EQ(out.clips.size(), 3U);
    EXPECT_EQ(std::get<Rejection>(out.clips[2]).reason, "persons: 1, not 2; --persons 1 takes such clips");
    out.clips.pop_back();
    const auto clips = taken(std::move(out.clips));
    EXPECT_EQ(clips[0]->name, "walk_1_a");
    EXPECT_EQ(clips[0]->fields, (Names{"walk", "1"}));
    kernels::Device device;
    std::vector<std::uint32_t> frames;
    const auto both = format.clean(device, 0, std::span(clips).first(1), frames);
    EXPECT_EQ(frames, std::vector<std::uint32_t>{3});
    expect_two_persons(root_x(both));
}

TEST(BvhFormat, PersonsOfDifferentClipsAreRefused) {
    const test::TempDir dir;
    auto o = options();
    o.pattern = "{action}_{take}_{person}";
    const auto longer = replaced(person(), "Frames: 3", "Frames: 5") + "3 0 0 0 3\n4 0 0 0 4\n";
    const auto first = (dir / "walk_1_a.bvh").string(), second = (dir / "walk_1_b.bvh").string();
    test::write_file(second, longer);
    test::write_file(first, person());
    BvhFormat format(o);
    const Text a(person()), b(longer);
    format.survey({first, "walk_1_a", a.view(), "walk_1_a.bvh", 0});
    format.survey({second, "walk_1_b", b.view(), "walk_1_b.bvh", 1});
    format.settle();
    Collected out;
    format.read({first, "walk_1_a", a.view(), "walk_1_a.bvh", 0}, out);
    ASSERT_EQ(out.clips.size(), 1U);
    EXPECT_EQ(std::get<Rejection>(out.clips[0]).reason,
              "persons of 3 and of 5 frames are of different clips");
    // Out of an archive one file cannot be read beside another.
    EXPECT_NE(error_of([&] {
                  settled(o, {{"walk_1_a.bvh", person()}, {"walk_1_b.bvh", person()}});
              }).find("cannot be read out of an archive; unpack it and give the folder"),
              std::string::npos);
}

TEST(BvhFormat, LabelsCutAFileIntoClips) {
    const test::TempDir dir;
    test::write_file(
        dir / "labels.csv",
        "file,action,start_frame,end_frame\nwalk_1.bvh,walk,0,1\nwalk_1.bvh,stop,1,\nwalk_1.bvh,none,9,12\n");
    auto o = options();
    o.pattern = "";
    o.labels = (dir / "labels.csv").string();
    const auto format = settled(o, {{"walk_1.bvh", person()}, {"walk_2.bvh", person()}});
    EXPECT_EQ(format->datasets()[0].classes, (Names{"none", "stop", "walk"}));
    auto clips = read(*format, "walk_1.bvh", person());
    ASSERT_EQ(clips.size(), 3U);
    EXPECT_EQ(std::get<Rejection>(clips[2]).reason, "clip walk_1_9-12: no frame is left of 3: from 9 to 3");
    clips.pop_back();
    const auto sound = taken(std::move(clips));
    EXPECT_EQ(sound[1]->name, "walk_1_1-end");
    EXPECT_EQ(sound[1]->label, 1U);
    kernels::Device device;
    std::vector<std::uint32_t> frames;
    format->clean(device, 0, sound, frames);
    EXPECT_EQ(frames, (std::vector<std::uint32_t>{1, 2}));
    EXPECT_EQ(refusal(*format, person(), "walk_2.bvh"), fmt::format("no row of {} is for it", o.labels));
}

TEST(BvhFormat, AFirstFrameThatJumpsIsLeftOutWhereItsLabelStarts) {
    const test::TempDir dir;
    test::write_file(dir / "labels.csv", "file,action,start_frame\nwalk_1.bvh,walk,1\n");
    const auto text = replaced(person("y", 1, "0 0 0 0 0\n-500 0 0 0 0\n"), "Frames: 4", "Frames: 5");
    auto o = options();
    o.pattern = "";
    o.labels = (dir / "labels.csv").string();
    const auto doubts = [&] {
        return taken(read(*settled(o, {{"walk_1.bvh", text}}), "walk_1.bvh", text))[0]->doubts;
    };
    EXPECT_EQ(doubts(),
              Names{"the first frame is a jump, as from a reference pose; a start_frame of one more "
                    "in the labels leaves it out"});
    o.skip_first = 1;
    EXPECT_EQ(doubts(),
              Names{"the first frame is a jump, as from a reference pose; --skip-first 2 leaves it out"});
}

TEST(BvhFormat, ALabelThatEndsBehindTheFileIsCutOffThereAndSaysSo) {
    const test::TempDir dir;
    test::write_file(dir / "labels.csv",
                     "file,action,start_frame,end_frame\nwalk_1.bvh,whole,0,3\nwalk_1.bvh,long,0,4\n");
    auto o = options();
    o.pattern = "";
    o.labels = (dir / "labels.csv").string();
    const auto clips = taken(read(*settled(o, {{"walk_1.bvh", person()}}), "walk_1.bvh", person()));
    ASSERT_EQ(clips.size(), 2U);
    EXPECT_EQ(clips[0]->doubts, Names{});
    EXPECT_EQ(clips[1]->doubts, Names{"the label ends behind the motion: cut off there"});
}

TEST(BvhFormat, ReadsAcclaimFilesWithTheSkeletonsBesideThem) {
    const std::string asf =
        ":root\norder TX TY TZ RX RY RZ\n:bonedata\nbegin\nname lfemur\ndirection 0 -1 0\nlength 15\naxis 0 "
        "0 0 XYZ\ndof rx\nend\n"
        "begin\nname thorax\ndirection 0 1 0\nlength 15\naxis 0 0 0 XYZ\nend\n:hierarchy\nroot thorax "
        "lfemur\n";
    const std::string amc = ":DEGREES\n1\nroot 0 0 0 0 0 0\nlfemur 0\n2\nroot 1 0 0 0 0 0\nlfemur 90\n";
    auto o = options();
    o.scale = "auto";
    // The survey meets the skeleton last. It is the first subject's; the second has none of its own.
    const Files files{{"a/7.asf", asf}, {"a/7_walk.amc", amc}, {"b/8_walk.amc", amc}};
    o.pattern = "{subject}_{action}";
    const auto format = settled(o, files);
    EXPECT_EQ(format->datasets()[0].topology, (Topology{{"root", "thorax", "lfemur"}, {-1, 0, 0}}));
    EXPECT_EQ(format->datasets()[0].fps, 120);
    EXPECT_TRUE(read(*format, "a/7.asf", asf).empty());
    EXPECT_EQ(refusal(*format, amc, "b/8_walk.amc"), "no skeleton 8.asf beside it; --asf FILE gives one");
    std::vector<std::uint32_t> frames;
    const auto out = cleaned(*format, {files[1]}, frames);
    const double scale = 0.0254 / 0.45, bone = unit(15 * scale);
    expect_near(out.motion,
                {-scale / 2, 0, 0, 0, bone, 0, 0, -bone, 0, scale / 2, 0, 0, 0, bone, 0, 0, 0, -bone});

    const test::TempDir dir;
    test::write_file(dir / "any.asf", asf);
    o.asf = (dir / "any.asf").string();
    EXPECT_EQ(refusal(*settled(o, files), amc, "b/8_walk.amc"), "taken");
    const auto broken = settled(o, {files[0], files[1], {"b/8.asf", asf.substr(0, 30)}});
    EXPECT_NE(refusal(*broken, amc, "b/8_walk.amc").find("its skeleton, 8.asf, is at fault: line"),
              std::string::npos);
}

}  // namespace
}  // namespace actformer::ingest
