#include "reports/pictures/contact_sheet.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>

#include "reports/pictures/draw.hpp"
#include "reports/pictures/render.hpp"
#include "reports/pictures/style.hpp"
#include "reports/pictures/text.hpp"
#include "tests/reports/motions/made_motions.hpp"
#include "tests/support/little_memory.hpp"

namespace actformer::reports {
namespace {

using testing::difference;
using testing::error_of;
using testing::Folder;
using testing::walkers;

cv::Mat blank(int width, int height) {
    return {height, width, CV_8UC3, cv::Scalar::all(255)};
}

Layout small() {
    Layout layout;
    layout.size = 90;
    layout.samples = 2;
    return layout;
}

/// How far a pixel's hue is from that of 0xRRGGBB: the angle between them as directions away from grey.
bool looks_like(const cv::Vec3b& pixel, int rgb) {
    const auto away_from_grey = [](cv::Vec3f c) {
        return cv::Vec3f(c - cv::Vec3f::all((c[0] + c[1] + c[2]) / 3));
    };
    const auto a = away_from_grey(cv::Vec3f(pixel)), b = away_from_grey(style::vec(rgb));
    return cv::norm(a) > 15 && a.dot(b) > 0.97 * cv::norm(a) * cv::norm(b);
}

TEST(Stage, LeftAndRightHaveTheirColours) {
    const auto motion = walkers(1, 10);
    const Stage stage(motion, parse_view("front"));
    auto cell = blank(300, 400);
    stage.draw(cell, 0);
    const auto pixel = [&](std::size_t j) {
        const float* x = motion.at(0, 0, j);
        const auto seen = stage.camera(0, cell.size()).project({x[0], x[1], x[2]});
        return cell.at<cv::Vec3b>(static_cast<int>(seen.y), static_cast<int>(seen.x));
    };
    EXPECT_TRUE(stage.has_sides());
    for (const std::size_t left : {5, 6, 13})
        EXPECT_TRUE(looks_like(pixel(left), style::body(0).left)) << left;
    for (const std::size_t right : {9, 10, 17})
        EXPECT_TRUE(looks_like(pixel(right), style::body(0).right)) << right;
    EXPECT_TRUE(looks_like(pixel(3), style::body(0).middle));
}

TEST(Stage, PersonsHaveTheirColours) {
    const auto motion = walkers(2, 10);
    const Stage stage(motion, parse_view("front"));
    auto cell = blank(500, 400);
    stage.draw(cell, 0);
    for (std::size_t p = 0; p < 2; ++p) {
        const float* head = motion.at(0, p, 3);
        const auto seen = stage.camera(0, cell.size()).project({head[0], head[1], head[2]});
        EXPECT_TRUE(looks_like(cell.at<cv::Vec3b>(static_cast<int>(seen.y), static_cast<int>(seen.x)),
                               style::body(p).middle));
    }
}

TEST(Stage, NearLimbsHideFarOnes) {
    // Two bars, one behind the other, and no names to go by: the second person stands nearer.
    JointMotion motion{"bars", {{"a", "b"}, {-1, 0}}, 2, 1, 30, {-1, 1, 0, 1, 1, 0, -1, 1, 1, 1, 1, 1}, {},
                       {}};
    const Stage stage(motion, parse_view("90,0"));  // along the line of persons
    auto cell = blank(200, 200);
    stage.draw(cell, 0);
    const auto eye = stage.camera(0, cell.size());
    const auto middle = eye.project({0, 1, 1});
    const bool second_is_near = eye.project({0, 1, 1}).nearness > eye.project({0, 1, 0}).nearness;
    EXPECT_TRUE(looks_like(cell.at<cv::Vec3b>(static_cast<int>(middle.y), static_cast<int>(middle.x)),
                           style::body(second_is_near ? 1 : 0).left));
}

TEST(Stage, AbsentBodiesAreNotDrawn) {
    auto motion = walkers(1, 2);
    motion.seen = {1, 0};
    const Stage stage(motion, parse_view("0,0"));  // level: without floor and shadow
    auto there = blank(100, 150), gone = blank(100, 150);
    stage.draw(there, 0);
    stage.draw(gone, 1);
    EXPECT_GT(difference(there, blank(100, 150)), 0.02);
    EXPECT_EQ(difference(gone, blank(100, 150)), 0);
}

TEST(Stage, DrawsAnySkeleton) {
    const JointMotion dot{"dot", {{"joint"}, {-1}}, 1, 2, 30, {0, 0, 0, 0, 0, 0}, {}, {}};
    const JointMotion folded{
        "all in one place", {{"a", "b", "Head"}, {-1, 0, 1}}, 1, 1, 30, std::vector<float>(9, 3.0F), {}, {}};
    for (const auto* motion : {&dot, &folded}) {
        auto cell = blank(60, 80);
        Stage(*motion, {}).draw(cell, 0);
        EXPECT_GT(difference(cell, blank(60, 80)), 0.01) << motion->title;
    }
}

TEST(Stage, SurvivesAJointThatFliesOff) {
    auto motion = walkers(1, 60);
    motion.joints[(30 * 25 + 7) * 3] = 9e4F;
    auto cell = blank(100, 150);
    Stage(motion, {}).draw(cell, 30);
    EXPECT_GT(difference(cell, blank(100, 150)), 0.02);
}

TEST(Render, NamesThePictureThatThereIsNoMemoryFor) {
    if (test::address_sanitized) GTEST_SKIP() << test::why_not;
    const Folder folder;
    Layout layout;
    layout.size = 4000;
    layout.columns = 6;
    const auto draw = [&] {
        test::leave_little_memory();
        const auto said = error_of([&] { render({walkers(1, 30)}, layout, folder / "sheet.png"); });
        const auto begins = (folder / "sheet.png").string() + ": cannot be drawn: ";
        std::_Exit(said.starts_with(begins) && said.find("smaller --size") != std::string::npos ? 3 : 4);
    };
    EXPECT_EXIT(draw(), ::testing::ExitedWithCode(3), "");
    EXPECT_EQ(folder.files(), 0U);
}

TEST(ContactSheet, HasARowAMotionAndAColumnASnapshot) {
    const auto one = contact_sheet({walkers(1, 30)}, small());
    const auto two = contact_sheet({walkers(1, 30), walkers(1, 30)}, small());
    auto layout = small();
    layout.columns = 4;
    const auto narrow = contact_sheet({walkers(1, 30)}, layout);
    EXPECT_EQ(one.cols, two.cols);
    EXPECT_GT(two.rows, one.rows + layout.size);
    const int margins = 2 * narrow.cols - one.cols;
    EXPECT_EQ((one.cols - margins) % 8, 0);
    EXPECT_EQ(2 * (narrow.cols - margins), one.cols - margins);

    layout.columns = 12;
    const auto few = contact_sheet({walkers(1, 5)}, layout);  // no more snapshots than frames
    layout.columns = 5;
    EXPECT_EQ(few.cols, contact_sheet({walkers(1, 5)}, layout).cols);
}

TEST(ContactSheet, SnapshotsDiffer) {
    const auto sheet = contact_sheet({walkers(1, 30)}, small());
    const int width = sheet.cols / 8;
    EXPECT_GT(difference(sheet.colRange(0, width), sheet.colRange(sheet.cols - width, sheet.cols)), 0.01);
}

TEST(Animation, HasAClassARowWhereOneHasFewerMotions) {
    const auto picture = [](const std::vector<std::uint32_t>& labels, int across) {
        std::vector<JointMotion> motions(labels.size(), walkers(1, 4));
        for (std::size_t i = 0; i < labels.size(); ++i) motions[i].label = labels[i];
        auto layout = small();
        layout.across = across;
        return animation(motions, layout).draw(0);
    };
    const auto whole = picture({0, 0, 1, 1}, 2), uneven = picture({0, 1, 1}, 2);
    ASSERT_EQ(uneven.size(), whole.size());
    const int x = whole.cols / 2, third = whole.rows / 3;  // of two rows and the legend
    const cv::Rect above(x, 0, x, third), below(x, 2 * third, x, third);
    const cv::Mat paper(above.size(), CV_8UC3, style::scalar(style::paper));
    EXPECT_GT(difference(whole(above), paper), 0.01);
    EXPECT_EQ(difference(uneven(above), paper), 0);
    EXPECT_EQ(difference(uneven(below), whole(below)), 0);
    EXPECT_EQ(picture({0, 1, 1}, 100).size(), whole.size()) << "no wider than the largest class";
}

TEST(ContactSheet, TakesAnyTitle) {
    auto motion = walkers(1, 3);
    std::string every_byte;
    for (int c = 1; c < 256; ++c) every_byte += static_cast<char>(c);
    for (const auto& title : {std::string(100000, 'W'), std::string("喝水 · übergeben · пить · 💧"),
                              every_byte, std::string("\xff\xfe\xe2\x80"), std::string("a\nb\tc"),
                              std::string(50000, '\xe2'), std::string()}) {
        motion.title = title;
        EXPECT_FALSE(contact_sheet({motion}, small()).empty());
        EXPECT_FALSE(animation({motion}, small()).draw(1).empty());
    }
}

TEST(ContactSheet, RefusesWhatCannotBeLaidOut) {
    auto layout = small();
    EXPECT_NE(error_of([&] { contact_sheet({}, layout); }).find("no motion"), std::string::npos);
    EXPECT_NE(error_of([&] { contact_sheet({walkers(1, 0)}, layout); }).find("no frames"), std::string::npos);
    layout.size = 4000;
    layout.columns = 100;
    EXPECT_NE(error_of([&] { contact_sheet({walkers(1, 200)}, layout); }).find("smaller --size"),
              std::string::npos);
    layout.size = 5;
    EXPECT_NE(error_of([&] { contact_sheet({walkers(1, 2)}, layout); }).find("5 pixels"), std::string::npos);
}

TEST(ContactSheet, IsAPngWholeOrNotAtAll) {
    const Folder folder;
    const auto sheet = contact_sheet({walkers(2, 10)}, small());
    render({walkers(2, 10)}, small(), folder / "sheet.png");
    const auto read = cv::imread((folder / "sheet.png").string());
    ASSERT_EQ(read.size(), sheet.size());
    EXPECT_EQ(difference(read, sheet), 0);  // and drawn twice, it is the same
    EXPECT_EQ(folder.files(), 1U);

    EXPECT_NE(error_of([&] { write_png(folder / "no/such/sheet.png", sheet); }).find("make it first"),
              std::string::npos);
    EXPECT_NE(
        error_of([&] { write_png("/proc/sheet.png", sheet); }).find("/proc/sheet.png: cannot be written"),
        std::string::npos);
    EXPECT_NE(error_of([&] {
                  render({walkers(1, 2)}, small(), folder / "a.bmp");
              }).find(".png (contact sheet), .gif or .mp4"),
              std::string::npos);
    EXPECT_EQ(folder.files(), 1U);
}

TEST(Text, IsCutToFit) {
    EXPECT_EQ(fitted("walk", 200, 12), "walk");
    const auto cut = fitted("a rather long title of a motion", 80, 12);
    EXPECT_LE(text_width(cut, 12), 80);
    EXPECT_TRUE(cut.ends_with("…"));
    EXPECT_EQ(fitted("walk", 3, 12), "");
    EXPECT_EQ(drawable("a\nb\xff"
                       "c\xe2\x80\xa6\xe2\x80"),
              "a?b?c…??");
}

}  // namespace
}  // namespace actformer::reports
