#include "ingest/formats/ntu/skeleton_file.hpp"

#include <gtest/gtest.h>

#include "tests/support/skeleton_text.hpp"

using namespace actformer::ingest;
using namespace actformer::test;

namespace {

std::variant<SkeletonFile, Rejection> read(const std::string& text) {
    // Just the promised padding, in its own allocation, so that a sanitizer sees any byte read beyond it.
    const auto bytes = std::make_unique<char[]>(text.size() + 64);
    std::copy(text.begin(), text.end(), bytes.get());
    auto result = read_skeleton({bytes.get(), text.size()});
    if (auto* file = std::get_if<SkeletonFile>(&result))
        for (auto& body : file->bodies) body.id = {};  // views of the bytes that go away here
    return result;
}

SkeletonFile good(const std::string& text) {
    auto result = read(text);
    if (auto* why = std::get_if<Rejection>(&result)) throw std::runtime_error("rejected: " + why->reason);
    return std::get<SkeletonFile>(std::move(result));
}

std::string reason(const std::string& text) {
    const auto result = read(text);
    return std::holds_alternative<Rejection>(result) ? std::get<Rejection>(result).reason : "accepted";
}

std::string replaced(std::string text, const std::string& from, const std::string& to, int occurrence = 1) {
    std::size_t at = text.find(from);
    while (--occurrence) at = text.find(from, at + 1);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST(SkeletonFile, TakesLimbsFromParentToChildToTheLastDigit) {
    const auto motion = random_motion(7, 1);
    const auto file = good(skeleton_text(7, {always_seen("72057594037931101", motion)}));
    ASSERT_EQ(file.frames, 7U);
    ASSERT_EQ(file.bodies.size(), 1U);
    ASSERT_EQ(file.bodies[0].times, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6}));
    const auto printed = [](double v) { return std::stod(fmt::format("{:.7g}", v)); };
    for (std::size_t t = 0; t < 7; ++t)
        for (std::size_t j = 0; j < 25; ++j)
            for (std::size_t d = 0; d < 3; ++d) {
                const double from =
                    j == 0 ? printed(motion[0][0][d]) : printed(motion[t][ntu25().parents[j]][d]);
                EXPECT_EQ(file.bodies[0].limbs[(t * 25 + j) * 3 + d],
                          static_cast<float>(printed(motion[t][j][d]) - from));
            }
}

TEST(SkeletonFile, ReadsNumbersHoweverTheyAreWritten) {
    auto motion = random_motion(1, 1);
    auto text = skeleton_text(1, {always_seen("1", motion)});
    const auto line_of_joint_1 = [&](const std::string& x) {
        auto out = text;
        std::size_t at = 0;
        for (int line = 0; line < 5; ++line) at = out.find('\n', at) + 1;
        return out.replace(at, out.find(' ', at) - at, x);
    };
    const double root = std::stod(fmt::format("{:.7g}", motion[0][0][0]));
    for (const std::string x :
         {"0.5", "-0.5", "+0.5", ".5", "5", "12.25", "1.5e-05", "-1.5E-05", "0.0000001", "0.123456789",
          "0.12345678901234567890", "00.5", "1e2", "123456.789", "-0.05349901", "3.785547"})
        EXPECT_EQ(good(line_of_joint_1(x)).bodies[0].limbs[3], static_cast<float>(std::stod(x) - root)) << x;
    for (const std::string x :
         {"inf", "-inf", "nanx", "na", "1e7", "1e999", "0.5x", "0,5", "--1", "-", ".", "1.2.3", "0x10", "1e"})
        EXPECT_TRUE(reason(line_of_joint_1(x)).starts_with("line 6: "))
            << x << ": " << reason(line_of_joint_1(x));
}

TEST(SkeletonFile, ForgivesLineEndsMarksAndTrailingBlanks) {
    const std::vector<SeenBody> body{always_seen("72057594037931101", random_motion(5, 3))};
    const auto plain = good(skeleton_text(5, body)).bodies[0].limbs;
    EXPECT_EQ(good(skeleton_text(5, body, "\r\n")).bodies[0].limbs, plain);
    EXPECT_EQ(good(skeleton_text(5, body, " \t \n")).bodies[0].limbs, plain);
    EXPECT_EQ(good("\xEF\xBB\xBF" + skeleton_text(5, body)).bodies[0].limbs, plain);
    EXPECT_EQ(good(skeleton_text(5, body) + "\n \n\r\n").bodies[0].limbs, plain);
    auto unended = skeleton_text(5, body);
    unended.pop_back();
    EXPECT_EQ(good(unended).bodies[0].limbs, plain);
}

TEST(SkeletonFile, KeepsBodiesInTheOrderTheyAppear) {
    const auto motion = random_motion(4, 1);
    SeenBody late = always_seen("second", motion), early = always_seen("first", motion);
    late.frames[0] = late.frames[2] = std::nullopt;
    early.frames[3] = std::nullopt;
    const auto file = good(skeleton_text(4, {late, early}));
    ASSERT_EQ(file.bodies.size(), 2U);
    EXPECT_EQ(file.bodies[0].times, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(file.bodies[1].times, (std::vector<std::uint32_t>{1, 3}));
}

TEST(SkeletonFile, LetsTheLaterOfTwoEntriesOfABodyWin) {
    const auto a = random_motion(1, 1), b = random_motion(1, 2);
    const auto twice = good(skeleton_text(1, {always_seen("same", a), always_seen("same", b)}));
    ASSERT_EQ(twice.bodies.size(), 1U);
    ASSERT_EQ(twice.bodies[0].times.size(), 1U);
    EXPECT_EQ(twice.bodies[0].limbs[3], good(skeleton_text(1, {always_seen("same", b)})).bodies[0].limbs[3]);
}

namespace {

const Pose nowhere{};

/// Position `d` of joint `j` in frame `i` of a body's detections, relative to the clip's first root.
double position(const Body& body, std::size_t i, std::size_t j, std::size_t d) {
    double sum = 0;
    for (auto at = static_cast<int>(j); at >= 0; at = ntu25().parents[static_cast<std::size_t>(at)])
        sum += body.limbs[(i * 25 + static_cast<std::size_t>(at)) * 3 + d];
    return sum;
}

}  // namespace

TEST(SkeletonFile, ABodyOfZerosOrNansWasNotSeen) {
    const auto motion = random_motion(8, 1);
    auto seen = always_seen("1", motion), unseen = seen;
    seen.frames[2] = seen.frames[3] = seen.frames[7] = nowhere;
    unseen.frames[2] = unseen.frames[3] = unseen.frames[7] = std::nullopt;
    const auto file = good(skeleton_text(8, {seen}));
    EXPECT_TRUE(file.filled);
    ASSERT_EQ(file.bodies.size(), 1U);
    EXPECT_EQ(file.bodies[0].times, (std::vector<std::uint32_t>{0, 1, 4, 5, 6}));
    const auto gone = good(skeleton_text(8, {unseen}));
    EXPECT_FALSE(gone.filled);
    EXPECT_EQ(file.bodies[0].limbs, gone.bodies[0].limbs);
    for (auto& joint : *seen.frames[3]) joint = {NAN, NAN, NAN};
    EXPECT_EQ(good(skeleton_text(8, {seen})).bodies[0].limbs, gone.bodies[0].limbs);
}

TEST(SkeletonFile, ABodyOfZerosThroughoutIsNoBody) {
    const SeenBody nobody{"ghost", std::vector<std::optional<Pose>>(6, nowhere)};
    const auto one = good(skeleton_text(6, {nobody, always_seen("1", random_motion(6, 1))}));
    ASSERT_EQ(one.bodies.size(), 1U);
    EXPECT_EQ(one.bodies[0].limbs, good(plain_clip(6)).bodies[0].limbs);
    EXPECT_TRUE(good(skeleton_text(6, {nobody})).bodies.empty());
}

TEST(SkeletonFile, JointsOfZerosOrNansAreFilledFromTheFramesAround) {
    auto motion = random_motion(9, 4);
    auto broken = motion;
    const std::size_t elbow = 5, wrist = 6, root = 0;
    broken[3][elbow] = broken[4][elbow] = {0, 0, 0};
    broken[0][wrist] = broken[1][wrist] = {NAN, 0.5, 3};
    broken[8][root] = {0, 0, 0};
    const auto file = good(skeleton_text(9, {always_seen("1", broken)}));
    EXPECT_TRUE(file.filled);
    ASSERT_EQ(file.bodies[0].times.size(), 9U);
    for (std::size_t d = 0; d < 3; ++d) {
        const auto origin = motion[0][root][d];
        const auto expect_at = [&](std::size_t frame, std::size_t joint, double where) {
            // seven digits of text, then floats over a chain of limbs
            EXPECT_NEAR(position(file.bodies[0], frame, joint, d), where - origin, 3e-6)
                << "frame " << frame << " joint " << joint;
        };
        for (const double part : {1.0, 2.0})
            expect_at(2 + static_cast<std::size_t>(part), elbow,
                      motion[2][elbow][d] + part / 3 * (motion[5][elbow][d] - motion[2][elbow][d]));
        expect_at(0, wrist, motion[2][wrist][d]);
        expect_at(1, wrist, motion[2][wrist][d]);
        expect_at(8, root, motion[7][root][d]);
        expect_at(3, 7, motion[3][7][d]);  // the hand hangs on the wrist and stays where it was seen
        expect_at(5, elbow, motion[5][elbow][d]);
    }
}

TEST(SkeletonFile, ABodyWithAJointThatIsNeverSeenIsNone) {
    auto headless = random_motion(5, 1);
    for (auto& pose : headless) pose[3] = {0, 0, 0};
    const auto file =
        good(skeleton_text(5, {always_seen("headless", headless), always_seen("1", random_motion(5, 2))}));
    ASSERT_EQ(file.bodies.size(), 1U);
    EXPECT_EQ(file.bodies[0].limbs, good(plain_clip(5, 2)).bodies[0].limbs);
}

TEST(SkeletonFile, AcceptsFramesAndClipsWithoutABody) {
    EXPECT_TRUE(good("0\n").bodies.empty());
    EXPECT_EQ(good("3\n0\n0\n0\n").frames, 3U);
}

TEST(SkeletonFile, NamesTheLineAndWhatIsWrongWithIt) {
    const auto text = plain_clip(3);
    EXPECT_EQ(reason(""), "an empty file");
    EXPECT_EQ(reason("hello\n"), "line 1: 'hello' where the number of frames should be");
    EXPECT_EQ(reason(replaced(text, "3\n", "-1\n")), "line 1: '-1' where the number of frames should be");
    EXPECT_EQ(reason(replaced(text, "3\n", "3 frames\n")), "line 1: 2 fields, not 1");
    EXPECT_TRUE(reason(replaced(text, "3\n", "1000000000000000\n"))
                    .starts_with("line 1: 1000000000000000 frames cannot be"));
    EXPECT_TRUE(reason(replaced(text, "3\n", "99999999999999999999\n"))
                    .starts_with("line 1: '99999999999999999999'"));
    EXPECT_EQ(reason(replaced(text, "\n1\n", "\n-1\n")), "line 2: '-1' where the number of bodies should be");
    EXPECT_TRUE(reason(replaced(text, "\n1\n", "\n1000000000000000\n")).starts_with("line 30: "));
    EXPECT_EQ(reason(replaced(text, "\n25\n", "\n20\n")), "line 4: 20 joints, not 25");
    EXPECT_EQ(reason(replaced(text, "\n25\n", "\n26\n")), "line 4: 26 joints, not 25");
    EXPECT_EQ(reason(replaced(text, " 2\n25\n", "\n25\n")), "line 3: 9 fields, not 10");
    EXPECT_EQ(reason(replaced(text, "0.96 -0.12 2\n", "0.96 -0.12\n")), "line 5: 11 fields, not 12");
    EXPECT_EQ(reason(replaced(text, "0.96 -0.12 2\n", "0.96 -0.12 2 2\n")), "line 5: 13 fields, not 12");
    EXPECT_EQ(reason(text + "0.5\n"), "line 86: text after the last frame that line 1 counts");
    EXPECT_EQ(reason(replaced(text, "3\n", "4\n")),
              "ends after line 85, in frame 3, where bodies should be: cut short");
}

TEST(SkeletonFile, RejectsEveryTruncation) {
    const auto text = plain_clip(2);
    EXPECT_EQ(reason(text), "accepted");
    for (std::size_t size = 0; size + 2 < text.size(); ++size)
        EXPECT_NE(reason(text.substr(0, size)), "accepted")
            << "cut to " << size << " bytes of " << text.size();
}

TEST(SkeletonFile, ShowsNoControlCharactersOfAHostileFile) {
    const auto why = reason("\x1b[31mred\n");
    EXPECT_EQ(why.find('\x1b'), std::string::npos) << why;
}
