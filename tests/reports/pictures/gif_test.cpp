#include "reports/pictures/gif.hpp"

#include <gif_lib.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "reports/pictures/palette.hpp"
#include "reports/pictures/render.hpp"
#include "tests/reports/motions/made_motions.hpp"

namespace actformer::reports {
namespace {

using testing::difference;
using testing::error_of;
using testing::Folder;
using testing::walkers;

/// A GIF as a viewer shows it: every frame whole.
struct Played {
    std::vector<cv::Mat> frames;
    std::vector<int> centiseconds;
    bool loops = false;

    explicit Played(const std::filesystem::path& path) {
        const std::unique_ptr<GifFileType, void (*)(GifFileType*)> gif(
            DGifOpenFileName(path.c_str(), nullptr), [](GifFileType* g) { DGifCloseFile(g, nullptr); });
        if (!gif || DGifSlurp(gif.get()) != GIF_OK) throw std::runtime_error("not a GIF");
        cv::Mat screen(gif->SHeight, gif->SWidth, CV_8UC3, cv::Scalar::all(0));
        for (int i = 0; i < gif->ImageCount; ++i) {
            const auto& image = gif->SavedImages[i];
            for (int e = 0; e < image.ExtensionBlockCount; ++e)
                loops = loops || (image.ExtensionBlocks[e].Function == APPLICATION_EXT_FUNC_CODE &&
                                  std::string(reinterpret_cast<char*>(image.ExtensionBlocks[e].Bytes), 11) ==
                                      "NETSCAPE2.0");
            GraphicsControlBlock control{};
            DGifSavedExtensionToGCB(gif.get(), i, &control);
            const auto& d = image.ImageDesc;
            for (int y = 0; y < d.Height; ++y)
                for (int x = 0; x < d.Width; ++x) {
                    const int entry = image.RasterBits[y * d.Width + x];
                    if (entry == control.TransparentColor) continue;
                    const auto& c = gif->SColorMap->Colors[entry];
                    screen.at<cv::Vec3b>(d.Top + y, d.Left + x) = {c.Blue, c.Green, c.Red};
                }
            frames.push_back(screen.clone());
            centiseconds.push_back(control.DelayTime);
        }
    }
    int length() const {
        int sum = 0;
        for (const int c : centiseconds) sum += c;
        return sum;
    }
};

Layout small_film() {
    Layout layout;
    layout.size = 90;
    layout.samples = 2;
    return layout;
}

TEST(Gif, MovesAndLoops) {
    const Folder folder;
    const std::vector<JointMotion> motions{walkers(1, 20), walkers(2, 20)};
    render(motions, small_film(), folder / "walk.gif");
    const Played played(folder / "walk.gif");
    ASSERT_EQ(played.frames.size(), 20U);
    EXPECT_TRUE(played.loops);
    for (std::size_t i = 1; i < 20; ++i)
        EXPECT_GT(difference(played.frames[i - 1], played.frames[i]), 0.003) << i;
    EXPECT_EQ(folder.files(), 1U);

    // What is shown is what was drawn, but for the palette.
    const auto film = animation(motions, small_film());
    for (const std::size_t i : {0, 7, 19}) {
        const auto drawn = film.draw(i);
        ASSERT_EQ(drawn.size(), played.frames[i].size());
        EXPECT_LT(cv::norm(drawn, played.frames[i], cv::NORM_L1) / static_cast<double>(drawn.total() * 3),
                  1.5)
            << i;
        EXPECT_EQ(played.frames[i].at<cv::Vec3b>(1, 1), cv::Vec3b(255, 255, 255));
    }
}

TEST(Gif, KeepsTime) {
    const Folder folder;
    for (const double fps : {10.0, 24.0, 30.0, 50.0, 120.0}) {
        render({walkers(1, 24, fps)}, small_film(), folder / "walk.gif");
        const Played played(folder / "walk.gif");
        EXPECT_NEAR(played.length(), 2400 / fps, 2) << fps;
        for (const int c : played.centiseconds) EXPECT_GE(c, 2) << fps;
        EXPECT_EQ(played.frames.size(), fps > 50 ? 10U : 24U);
    }
}

TEST(Gif, HoldsStill) {
    const Folder folder;
    Film film{5, 25, {31, 17}, [](std::size_t) { return cv::Mat(17, 31, CV_8UC3, cv::Scalar(10, 20, 30)); }};
    write_gif(folder / "still.gif", film);
    const Played played(folder / "still.gif");
    ASSERT_EQ(played.frames.size(), 5U);
    EXPECT_EQ(played.frames[4].at<cv::Vec3b>(16, 30), cv::Vec3b(10, 20, 30));
}

TEST(Gif, FailsWholeOrNotAtAll) {
    const Folder folder;
    std::ofstream(folder / "old.gif") << "the old one";
    Film film{3, 25, {8, 8}, [](std::size_t i) {
                  if (i == 2) throw std::runtime_error("no picture");
                  return cv::Mat(8, 8, CV_8UC3, cv::Scalar::all(9.0 * static_cast<double>(i)));
              }};
    EXPECT_NE(error_of([&] { write_gif(folder / "old.gif", film); }), "");
    std::string kept;
    std::getline(std::ifstream(folder / "old.gif"), kept);
    EXPECT_EQ(kept, "the old one");
    EXPECT_EQ(folder.files(), 1U);
    EXPECT_NE(error_of([&] { write_gif(folder / "none/a.gif", film); }).find("make it first"),
              std::string::npos);
    EXPECT_NE(error_of([&] { write_gif("/proc/a.gif", film); }).find("/proc/a.gif: cannot be written"),
              std::string::npos);
}

TEST(Palette, KeepsFewColoursExactly) {
    cv::Mat picture(10, 10, CV_8UC3, cv::Scalar(255, 255, 255));
    picture.row(0).setTo(cv::Scalar(1, 2, 3));
    picture.row(1).setTo(cv::Scalar(254, 254, 254));
    const auto colours = median_cut({picture}, 255);
    EXPECT_EQ(colours.size(), 3U);
    EXPECT_EQ(colours[0], cv::Vec3b(255, 255, 255));
    Palette palette(colours);
    EXPECT_EQ(palette.colours()[palette.nearest({1, 2, 3})], cv::Vec3b(1, 2, 3));
    EXPECT_EQ(palette.nearest({255, 255, 255}), 0);
}

TEST(Palette, SpreadsOverMany) {
    cv::Mat picture(64, 256, CV_8UC3);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 256; ++x)
            picture.at<cv::Vec3b>(y, x) =
                cv::Vec3b(cv::saturate_cast<std::uint8_t>(x), cv::saturate_cast<std::uint8_t>(4 * y), 100);
    const auto colours = median_cut({picture}, 255);
    EXPECT_EQ(colours.size(), 255U);
    Palette palette(colours);
    for (int y = 0; y < 64; y += 7)
        for (int x = 0; x < 256; x += 5) {
            const auto c = picture.at<cv::Vec3b>(y, x);
            EXPECT_LT(cv::norm(cv::Vec3d(palette.colours()[palette.nearest(c)]) - cv::Vec3d(c)), 24);
        }
}

}  // namespace
}  // namespace actformer::reports
