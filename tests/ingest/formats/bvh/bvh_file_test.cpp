// The BVH reader on what is out there and on what is hostile.
#include "ingest/formats/bvh/bvh_file.hpp"
#include "tests/support/replaced.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace actformer::ingest {
namespace {

using test::replaced;

using kernels::Channel;

std::variant<std::vector<Recording>, Rejection> parse(const std::string& text) {
    const std::string padded = text + std::string(64, '\0');
    return parse_bvh(std::string_view(padded).substr(0, text.size()));
}

std::vector<Recording> persons(const std::string& text) {
    auto result = parse(text);
    if (const auto* r = std::get_if<Rejection>(&result)) {
        ADD_FAILURE() << r->reason;
        return {};
    }
    return std::get<std::vector<Recording>>(std::move(result));
}

Recording sound(const std::string& text) {
    auto found = persons(text);
    EXPECT_EQ(found.size(), 1U);
    return found.empty() ? Recording() : std::move(found[0]);
}

std::string reason(const std::string& text) {
    const auto result = parse(text);
    if (!std::holds_alternative<Rejection>(result)) return "taken";
    return std::get<Rejection>(result).reason;
}

const std::string hierarchy =
    "HIERARCHY\n"                                                                 // line 1
    "ROOT Hips\n"                                                                 // 2
    "{\n"                                                                         // 3
    "  OFFSET 0 1.5 0\n"                                                          // 4
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"  // 5
    "  JOINT Left Leg\n"                                                          // 6
    "  {\n"                                                                       // 7
    "    OFFSET 1 -2 3e1\n"                                                       // 8
    "    CHANNELS 3 Yrotation Xrotation Zrotation\n"                              // 9
    "    End Site\n"                                                              // 10
    "    {\n"                                                                     // 11
    "      OFFSET 0 -4 0\n"                                                       // 12
    "    }\n"                                                                     // 13
    "  }\n"                                                                       // 14
    "}\n";                                                                        // 15
const std::string motion =
    "MOTION\n"                   // 16
    "Frames:\t2\n"               // 17
    "Frame Time:\t0.0333333\n"   // 18
    "1 2 3 4 5 6 7 8 9\n"        // 19
    "2 2 3.5 -4 5 6 7 8 370\n";  // 20
const std::string simple = hierarchy + motion;

std::string with_frame(const std::string& line) {
    return replaced(simple, "2 2 3.5 -4 5 6 7 8 370", line);
}

TEST(BvhFile, ReadsHierarchyAndMotion) {
    const Recording file = sound(simple);
    ASSERT_EQ(file.joints.size(), 3U);
    EXPECT_EQ(file.joints[0].name, "Hips");
    EXPECT_EQ(file.joints[0].parent, -1);
    EXPECT_EQ(file.joints[1].name, "Left Leg");
    EXPECT_EQ(file.joints[1].parent, 0);
    EXPECT_EQ(file.joints[1].offset, (std::array<double, 3>{1, -2, 30}));
    EXPECT_EQ(file.joints[1].first_channel, 6U);
    EXPECT_EQ(file.joints[1].channels,
              (std::vector<Channel>{Channel::y_rotation, Channel::x_rotation, Channel::z_rotation}));
    EXPECT_TRUE(file.joints[2].end_site);
    EXPECT_EQ(file.joints[2].parent, 1);
    EXPECT_EQ(file.joints[2].offset, (std::array<double, 3>{0, -4, 0}));
    EXPECT_EQ(file.channels, 9U);
    EXPECT_EQ(file.frames, 2U);
    EXPECT_EQ(file.fps(), 30);
    // By channel; the root's position from its first frame on, and angles within a turn.
    EXPECT_EQ(file.values, (std::vector<float>{0, 1, 0, 0, 0, 0.5, 4, -4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 10}));
}

TEST(BvhFile, TakesWhatOtherProgramsWrite) {
    const auto want = sound(simple);
    std::string crlf;
    for (const char c : simple) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    std::string one_line = hierarchy;
    for (auto& c : one_line)
        if (c == '\n') c = ' ';
    one_line = replaced(one_line, "ROOT Hips {", "ROOT Hips{");
    const std::string variants[] = {
        crlf,
        "\xEF\xBB\xBF" + simple,
        "\n\n " + simple + " \r\n\t\n",
        simple.substr(0, simple.size() - 1),
        replaced(simple, "8 9\n", "8 9 \t \n\n"),
        replaced(replaced(simple, "HIERARCHY", "Hierarchy"), "ROOT", "root"),
        replaced(replaced(simple, "Xposition", "XPOSITION"), "Yposition", "yposition"),
        replaced(replaced(simple, "Frames:\t2", "FRAMES : 2"), "Frame Time:\t", "frame  time:"),
        replaced(simple, "End Site", "END SITE"),
        replaced(simple, "      OFFSET 0 -4 0\n", "      OFFSET 0 -4 0\n CHANNELS 0\n"),
        one_line + motion,
    };
    for (const auto& text : variants) {
        const auto file = sound(text);
        EXPECT_EQ(file.values, want.values) << text;
        EXPECT_EQ(file.joints.size(), 3U) << text;
        EXPECT_EQ(file.joints[0].name, "Hips");
    }
}

TEST(BvhFile, TakesJointsWithoutChannelsOrEndSites) {
    auto text = replaced(simple, "    End Site\n    {\n      OFFSET 0 -4 0\n    }\n", "");
    EXPECT_EQ(sound(text).joints.size(), 2U);
    text = replaced(text, "CHANNELS 3 Yrotation Xrotation Zrotation", "CHANNELS 0");
    text = replaced(replaced(text, "6 7 8 9\n", "6\n"), "6 7 8 370\n", "6\n");
    EXPECT_EQ(sound(text).channels, 6U);
    EXPECT_EQ(sound(replaced(text, "    CHANNELS 0\n", "")).channels, 6U);
    EXPECT_EQ(
        sound(replaced(simple, "Zrotation Xrotation Yrotation", "Zrotation Xrotation Zrotation")).channels,
        9U);
}

TEST(BvhFile, KeepsSmallMotionFarFromTheOrigin) {
    const auto file =
        sound(replaced(with_frame("123456789.75 2 3 4 5 6 7 8 9"), "1 2 3 4", "123456789.5 2 3 4"));
    EXPECT_EQ(file.channel(0)[1], 0.25F);
}

TEST(BvhFile, RoundsTheRateToAWholeNumberNearby) {
    const auto fps = [](const char* time) { return sound(replaced(simple, "0.0333333", time)).fps(); };
    EXPECT_EQ(fps("0.0333"), 30);
    EXPECT_EQ(fps("0.008333"), 120);
    EXPECT_EQ(fps("0.00833333"), 120);
    EXPECT_EQ(fps("0.04"), 25);
    EXPECT_EQ(fps("0.08"), 12.5);
}

TEST(BvhFile, MakesNamesPrintable) {
    EXPECT_EQ(sound(replaced(simple, "Hips", "H\xFF\x01ps \xE8\x85\xB0")).joints[0].name,
              "H\\xFF\\x01ps \xE8\x85\xB0");
}

TEST(BvhFile, RefusesFramesNamingTheLine) {
    EXPECT_EQ(reason(with_frame("2 2 3.5 -4 5 6 7 8")), "line 20: 8 numbers, not 9");
    EXPECT_EQ(reason(with_frame("2 2 3.5 -4 5 6 7 8 9 10 11 ")), "line 20: 11 numbers, not 9");
    EXPECT_EQ(reason(with_frame("2 2 3.5 -4 5 6 7 8 nan")), "line 20: 'nan' is not a number");
    EXPECT_EQ(reason(with_frame("2 2 inf -4 5 6 7 8 9")), "line 20: 'inf' is not a number");
    EXPECT_EQ(reason(with_frame("2 2 3,5 -4 5 6 7 8 9")), "line 20: '3,5' is not a number");
    EXPECT_EQ(reason(with_frame("2 2 3.5.5 -4 5 6 7 8 9")), "line 20: '3.5.5' is not a number");
    EXPECT_EQ(reason(with_frame("2 2 1e30 -4 5 6 7 8 9")), "line 20: '1e30' is too large");
    EXPECT_EQ(reason(with_frame("2 2 3 1e999 5 6 7 8 9")), "line 20: '1e999' is not a number");
    EXPECT_EQ(reason(with_frame(std::string("2 2 3 4 5 6 7 8\0 9", 18))), "line 20: '\\x00' is not a number");
    EXPECT_EQ(reason(with_frame("")), "line 21: the text ends after 1 of 2 frames");
    EXPECT_EQ(reason(simple + "1 2 3 4 5 6 7 8 9\n"), "line 21: '1' after the 2 frames announced");
    EXPECT_EQ(reason(with_frame("2 2 3.5 -4")), "line 20: 4 numbers, not 9");
    EXPECT_EQ(reason(simple.substr(0, simple.size() - 10)), "line 20: 5 numbers, not 9");
}

TEST(BvhFile, RefusesFrameCountsAndTimes) {
    const auto frames = [](const char* n) {
        return reason(replaced(simple, "Frames:\t2", std::string("Frames:\t") + n));
    };
    EXPECT_EQ(frames("-1"), "line 17: -1 frames, not a whole number of 1 or more");
    EXPECT_EQ(frames("0"), "line 17: 0 frames, not a whole number of 1 or more");
    EXPECT_EQ(frames("1.5"), "line 17: 1.5 frames, not a whole number of 1 or more");
    EXPECT_EQ(frames("1000000000000000"),
              "line 17: 1000000000000000 frames of 9 numbers do not fit in the 64 bytes that follow");
    EXPECT_EQ(frames("1e300"), "line 17: 1e+300 frames of 9 numbers do not fit in the 64 bytes that follow");
    EXPECT_EQ(frames("many"), "line 17: 'many' in place of a number of frames");
    EXPECT_EQ(frames("nan"), "line 17: 'nan' in place of a number of frames");
    EXPECT_EQ(frames("3"), "line 21: the text ends after 2 of 3 frames");
    const auto time = [](const char* t) { return reason(replaced(simple, "0.0333333", t)); };
    EXPECT_EQ(time("0"), "line 18: frame time '0', not between 0.00001 and 1 seconds");
    EXPECT_EQ(time("-0.03"), "line 18: frame time '-0.03', not between 0.00001 and 1 seconds");
    EXPECT_EQ(time("30"), "line 18: frame time '30', not between 0.00001 and 1 seconds");
    EXPECT_EQ(time("nan"), "line 18: 'nan' in place of a frame time");
    EXPECT_EQ(time("0.03 s"), "line 18: 's' after the frame time");
    EXPECT_EQ(reason(replaced(simple, "Frames:", "Frame:")), "line 17: 'Frame:' in place of Frames:");
    EXPECT_EQ(reason(replaced(simple, "Frames:", "Frames")), "line 17: '2' in place of the : of Frames:");
    EXPECT_EQ(reason(replaced(simple, "Frame Time:", "Time:")), "line 18: 'Time:' in place of Frame Time:");
}

TEST(BvhFile, RefusesChannels) {
    const auto channels = [](const char* c) {
        return reason(
            replaced(simple, "CHANNELS 3 Yrotation Xrotation Zrotation", std::string("CHANNELS ") + c));
    };
    EXPECT_EQ(channels("2 Yrotation Xrotation Zrotation"), "line 9: more than the 2 channels announced");
    EXPECT_EQ(channels("4 Yrotation Xrotation Zrotation"),
              "line 10: 'End' in place of channel 4, one of Xposition Yposition Zposition Xrotation "
              "Yrotation Zrotation");
    EXPECT_EQ(
        channels("3 Yrotation Xscale Zrotation"),
        "line 9: 'Xscale' in place of channel 2, one of Xposition Yposition Zposition Xrotation Yrotation "
        "Zrotation");
    EXPECT_EQ(channels("-1"), "line 9: -1 channels of 'Left Leg', not a whole number up to 6");
    EXPECT_EQ(channels("7"), "line 9: 7 channels of 'Left Leg', not a whole number up to 6");
    EXPECT_EQ(channels("1e8"), "line 9: 100000000 channels of 'Left Leg', not a whole number up to 6");
    EXPECT_EQ(channels("Yrotation"), "line 9: 'Yrotation' in place of a number of channels");
    EXPECT_EQ(channels("2 Xposition xposition"), "line 9: channel 'xposition' twice");
    EXPECT_EQ(channels("0\nCHANNELS 0"), "line 10: a second CHANNELS of joint 'Left Leg'");
    EXPECT_EQ(reason(replaced(simple, "OFFSET 0 -4 0", "OFFSET 0 -4 0 CHANNELS 1 Xrotation")),
              "line 12: 1 channels of the End Site of 'Left Leg', not 0");
    EXPECT_EQ(reason("HIERARCHY ROOT a { OFFSET 0 0 0 }\nMOTION"), "line 2: no joint has a channel");
    EXPECT_EQ(
        reason("HIERARCHY ROOT a {\nOFFSET 0 0 0\nJOINT b {\nOFFSET 0 0 0 }\nCHANNELS 1 Xposition }\nMOTION"),
        "line 5: CHANNELS after a child joint");
}

TEST(BvhFile, RefusesHierarchies) {
    EXPECT_EQ(reason(""), "line 1: the end of the text in place of HIERARCHY; is this a BVH file?");
    EXPECT_EQ(reason("\xEF\xBB\xBF"),
              "line 1: the end of the text in place of HIERARCHY; is this a BVH file?");
    EXPECT_EQ(reason("PK\x03\x04"), "line 1: 'PK\\x03\\x04' in place of HIERARCHY; is this a BVH file?");
    EXPECT_EQ(reason("HIERARCHY\nMOTION\n"), "line 2: no ROOT before MOTION");
    EXPECT_EQ(reason("HIERARCHY\nJOINT a\n"), "line 2: 'JOINT' in place of ROOT");
    EXPECT_EQ(reason("HIERARCHY\nROOT\n{"), "line 2: a joint without a name");
    EXPECT_EQ(reason("HIERARCHY\nROOT a\nOFFSET"), "line 3: 'OFFSET' in place of {");
    EXPECT_EQ(reason(replaced(simple, "}\nMOTION", "MOTION")),
              "line 15: 'MOTION' inside joint 'Hips': a { without its }");
    EXPECT_EQ(reason(replaced(simple, "}\nMOTION", "}\n}\nMOTION")), "line 16: '}' in place of MOTION");
    EXPECT_EQ(reason(hierarchy + "ROOT Hips2\n{\n}\n" + motion), "line 18: joint 'Hips2' has no OFFSET");
    EXPECT_EQ(reason(replaced(simple, "JOINT Left Leg", "ROOT Left Leg")),
              "line 6: 'ROOT' in place of OFFSET, CHANNELS, JOINT, End Site or }");
    EXPECT_EQ(reason(replaced(simple, "Left Leg", "Hips")), "line 6: a second joint 'Hips'");
    EXPECT_EQ(reason(replaced(simple, "    OFFSET 1 -2 3e1\n", "")),
              "line 13: joint 'Left Leg' has no OFFSET");
    EXPECT_EQ(reason(replaced(simple, "1 -2 3e1", "1 -2")), "line 9: 'CHANNELS' in place of an offset");
    EXPECT_EQ(reason(replaced(simple, "1 -2 3e1", "1 -2 3 4")),
              "line 8: '4' in place of OFFSET, CHANNELS, JOINT, End Site or }");
    EXPECT_EQ(reason(replaced(simple, "1 -2 3e1", "1 nan 3")), "line 8: 'nan' in place of an offset");
    EXPECT_EQ(reason(replaced(simple, "1 -2 3e1", "1 2e20 3")), "line 8: '2e20' is too large for an offset");
    EXPECT_EQ(reason(replaced(simple, "OFFSET 1 -2 3e1", "OFFSET 1 2 3 OFFSET 1 2 3")),
              "line 8: a second OFFSET of joint 'Left Leg'");
    EXPECT_EQ(reason(replaced(simple, "OFFSET 0 -4 0", "OFFSET 0 -4 0 JOINT x")),
              "line 12: 'JOINT' in place of OFFSET, CHANNELS, JOINT, End Site or }");
}

TEST(BvhFile, TwoRootsAreTwoPersons) {
    const std::string second =
        "ROOT Hips\n{\nOFFSET 7 8 9\nCHANNELS 2 Zposition Xrotation\nJOINT Leg\n{\nOFFSET 0 -5 0\nCHANNELS 1 "
        "Xrotation\n}\n}\n";
    auto text = hierarchy + second + motion;
    text = replaced(text, "7 8 9\n2 2", "7 8 9 20 -1 -2\n2 2");
    text = replaced(text, "7 8 370\n", "7 8 370 21 -3 -4\n");
    const auto both = persons(text);
    ASSERT_EQ(both.size(), 2U);
    const auto alone = sound(simple);
    EXPECT_EQ(both[0].values, alone.values);
    EXPECT_EQ(both[0].origin, (std::array<double, 3>{1, 2, 3}));
    ASSERT_EQ(both[1].joints.size(), 2U);
    EXPECT_EQ(both[1].joints[1].name, "Leg");
    EXPECT_EQ(both[1].joints[1].parent, 0);
    EXPECT_EQ(both[1].joints[1].first_channel, 2U);
    EXPECT_EQ(both[1].channels, 3U);
    EXPECT_EQ(both[1].values, (std::vector<float>{0, 1, -1, -3, -2, -4}));
    // Where it has no position channel it stands where its OFFSET says.
    EXPECT_EQ(both[1].origin, (std::array<double, 3>{7, 8, 20}));
    EXPECT_EQ(both[1].joints[0].offset, (std::array<double, 3>{0, 0, 0}));
}

TEST(BvhFile, RefusesBottomlessNestingWithoutRecursion) {
    std::string open;
    for (int i = 0; i < 100'000; ++i) open += "JOINT j" + std::to_string(i) + "\n{\nOFFSET 0 0 0\n";
    EXPECT_EQ(reason("HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\n" + open), "line 12290: more than 4096 joints");
}

TEST(BvhFile, RefusesEveryTruncation) {
    // Cut within the last number, or after it, nothing shows.
    for (std::size_t size = 0; size < simple.size() - 3; ++size) {
        const auto why = reason(simple.substr(0, size));
        ASSERT_EQ(why.substr(0, 5), "line ") << size << ": " << why;
        ASSERT_EQ(why.find('\n'), std::string::npos) << why;
    }
}

}  // namespace
}  // namespace actformer::ingest
