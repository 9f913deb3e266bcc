// BVH clips as a dataset: skeletons, labels, resampling, and what is refused.
#include "ingest/formats/bvh/bvh_format.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace actformer::ingest {
namespace {

using Names = std::vector<std::string>;

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), with);
}

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

BvhFile file_of(const std::string& text) {
    auto parsed = parse_bvh(Text(text).view());
    if (const auto* r = std::get_if<Rejection>(&parsed)) throw Error("{}", r->reason);
    return std::get<BvhFile>(std::move(parsed));
}

BvhOptions options() {
    BvhOptions o;
    o.dataset = "walks";
    o.pattern = "{action}_{index}";
    return o;
}

/// Of two files: the walk comes first and decides the skeleton; `run_1` is broken.
std::unique_ptr<BvhFormat> settled(const BvhOptions& o) {
    auto format = std::make_unique<BvhFormat>(o);
    const Text first(walk), second("HIERARCHY");
    format->survey({"b.bvh", "run_1", second.view(), "b.bvh", 1});
    format->survey({"a.bvh", "walk_1", first.view(), "a.bvh", 0});
    format->settle();
    return format;
}

std::string refusal(const BvhFormat& format, const std::string& text, const char* stem = "walk_1") {
    const Text raw(text);
    const auto parsed = format.parse({"a.bvh", stem, raw.view()});
    return std::holds_alternative<Rejection>(parsed) ? std::get<Rejection>(parsed).reason : "taken";
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

kernels::CleanedBatch cleaned(const BvhFormat& format, const std::vector<std::string>& texts,
                              std::vector<std::uint32_t>& frames) {
    std::vector<std::unique_ptr<RawClip>> clips;
    for (const auto& text : texts) {
        const Text raw(text);
        auto parsed = format.parse({"a.bvh", "walk_1", raw.view()});
        if (auto* r = std::get_if<Rejection>(&parsed)) throw Error("{}", r->reason);
        clips.push_back(std::get<std::unique_ptr<RawClip>>(std::move(parsed)));
    }
    kernels::Device device;
    return format.clean(device, 0, clips, frames);
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

TEST(BvhSkeleton, NamesTheFirstDifference) {
    const Topology wanted{{"a", "b", "c"}, {-1, 0, 1}};
    EXPECT_EQ(first_difference(wanted, wanted), "");
    EXPECT_EQ(first_difference({{"a", "x", "c"}, {-1, 0, 1}}, wanted), "joint 1 is 'x', not 'b'");
    EXPECT_EQ(first_difference({{"a", "b", "c"}, {-1, 0, 0}}, wanted),
              "joint 2 is 'c' below 'a', not 'c' below 'b'");
    EXPECT_EQ(first_difference({{"a", "b"}, {-1, 0}}, wanted), "joint 'c' is missing");
    EXPECT_EQ(first_difference({{"a", "b", "c", "d"}, {-1, 0, 1, 2}}, wanted), "one joint too many: 'd'");
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
    const Text raw(walk);
    const auto parsed = settled(options())->parse({"a.bvh", "walk_07", raw.view()});
    ASSERT_TRUE(std::holds_alternative<std::unique_ptr<RawClip>>(parsed));
    const auto& clip = *std::get<std::unique_ptr<RawClip>>(parsed);
    EXPECT_EQ(clip.name, "walk_07");
    EXPECT_EQ(clip.label, 1U);
    EXPECT_EQ(clip.fields, (Names{"walk", "07"}));
}

TEST(BvhFormat, CleansOnTheDevice) {
    std::vector<std::uint32_t> frames;
    const auto out = cleaned(*settled(options()), {walk}, frames);
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
    const auto out = cleaned(*settled(o), {walk, half}, frames);
    EXPECT_EQ(frames, (std::vector<std::uint32_t>{5, 3}));
    for (int t = 0; t < 5; ++t) EXPECT_NEAR(out.motion[t * 9 + 2], 0.1 - 0.05 * t, 1e-6) << t;
    o.fps = 4;  // fewer than recorded: frames 0 and 2.5, of which the second lies past the end
    cleaned(*settled(o), {walk}, frames);
    EXPECT_EQ(frames, (std::vector<std::uint32_t>{1}));
}

TEST(BvhFormat, TakesOtherOffsetsAndChannelOrders) {
    const auto settled_format = settled(options());
    const auto& format = *settled_format;
    EXPECT_EQ(refusal(format, replaced(walk, "OFFSET 0 -40 0", "OFFSET 0 -41 0")), "taken");
    EXPECT_EQ(refusal(format, replaced(walk, "Zrotation", "Xrotation")), "taken");
}

TEST(BvhFormat, TheFirstFileSaysWhichEndSitesThereAre) {
    auto o = options();
    const auto more = replaced(walk, "OFFSET 0 0 0\n}\n}", "OFFSET 0 0 5\n}\n}"),
               fewer = replaced(walk, "0 0 10", "0 0 0");
    EXPECT_EQ(refusal(*settled(o), more), "taken");
    EXPECT_EQ(refusal(*settled(o), fewer), "taken");
    o.end_sites = true;
    EXPECT_EQ(refusal(*settled(o), more), "taken");
    EXPECT_EQ(refusal(*settled(o), fewer),
              "another skeleton than the first file's: joint 3 is 'Foot end 2', not 'Foot end'");
}

TEST(BvhFormat, KeepsToTheClassesListed) {
    auto o = options();
    o.classes = {"walk", "jump"};
    const auto settled_format = settled(o);
    const auto& format = *settled_format;
    EXPECT_EQ(format.datasets()[0].classes, (Names{"walk", "jump"}));
    EXPECT_EQ(refusal(format, walk, "run_1"), "action 'run' is none of the classes");
    o.classes = {"jump"};
    EXPECT_EQ(error_of([&] { settled(o); }),
              "none of the classes jump is in a file name; the actions are run,walk");
    o.classes = {"walk", "walk"};
    EXPECT_EQ(error_of([&] { settled(o); }), "a class is listed twice: walk,walk");
}

TEST(BvhFormat, RefusesFilesThatDoNotBelong) {
    const auto settled_format = settled(options());
    const auto& format = *settled_format;
    EXPECT_EQ(refusal(format, walk, "walk"), "the name does not fit the pattern '{action}_{index}'");
    EXPECT_EQ(refusal(format, "HIERARCHY"), "line 1: the end of the text in place of ROOT");
    EXPECT_EQ(refusal(format, replaced(walk, "Hips", "Pelvis")),
              "no joint 'Hips', the root of the first file");
    EXPECT_EQ(refusal(format, replaced(walk, "Foot", "Toe")),
              "another skeleton than the first file's: joint 2 is 'Toe', not 'Foot'");
    EXPECT_EQ(refusal(format, replaced(walk, "Frame Time: 0.1", "Frame Time: 0.05")),
              "20 frames a second, not 10 as in the first file; --fps resamples all to one rate");
}

TEST(BvhFormat, RefusesPositionsThatAddToOffsets) {
    auto text = replaced(walk, "CHANNELS 1 Zrotation", "CHANNELS 3 Xposition Yposition Zposition");
    for (const char* line : {"10 90 0 0\n", "20 90 0 90\n", "30 90 0 90\n"})
        text = replaced(text, line, std::string(line).substr(0, 8) + " 0 0 0\n");
    EXPECT_EQ(refusal(*settled(options()), text),
              "the position channels of 'Knee' are 0 in place of its OFFSET; remove them");
}

TEST(BvhFormat, RefusesOptionsThatMakeNoSense) {
    const auto why = [](auto change) {
        auto o = options();
        change(o);
        return error_of([&] { settled(o); });
    };
    EXPECT_EQ(why([](BvhOptions& o) { o.scale = 0; }),
              "scale 0 is not a number of metres a unit; centimetres are 0.01");
    EXPECT_EQ(why([](BvhOptions& o) { o.fps = -1; }),
              "-1 frames a second cannot be resampled to; give 1 to 1000, or 0 for as recorded");
    EXPECT_EQ(why([](BvhOptions& o) { o.smooth = -1; }),
              "smoothing over -1 frames makes no sense; give 0 for none, or up to 1000");
    EXPECT_EQ(why([](BvhOptions& o) { o.root = "Head"; }),
              "no joint 'Head' to take as root; the joints are Floor, Hips, Knee, Foot");
    EXPECT_EQ(why([](BvhOptions& o) {
                  o.splits = {{"a/train", {{"stile", {"x"}, false}}}};
              }),
              "split a/train: the name pattern has no field 'stile'; it has action, index");
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
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.scale = 1; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.fps = 5; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.smooth = 1; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.end_sites = true; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.root = "Knee"; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.centre_windows = true; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.classes = {"walk"}; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.pattern = "{action}_{n}"; }));
    EXPECT_NE(plain, settings([](BvhOptions& o) { o.splits = {{"a", {{"index", {"1"}, false}}}}; }));
}

}  // namespace
}  // namespace actformer::ingest
