#include "reports/pictures/video.hpp"

#include <gtest/gtest.h>

#include <opencv2/videoio.hpp>

#include "reports/pictures/render.hpp"
#include "tests/reports/motions/made_motions.hpp"

namespace actformer::reports {
namespace {

using testing::error_of;
using testing::Folder;
using testing::walkers;

TEST(Video, PlaysWithEveryFrame) {
    const Folder folder;
    Layout layout;
    layout.size = 91;  // odd on purpose
    const std::vector<JointMotion> motions{walkers(1, 15), walkers(2, 25)};
    const auto film = animation(motions, layout);
    EXPECT_EQ(film.size.width % 2, 0);
    EXPECT_EQ(film.size.height % 2, 0);
    std::size_t watched = 0;
    render(motions, layout, folder / "walk.mp4", [&](std::size_t done, std::size_t all) {
        EXPECT_EQ(all, 25U);
        EXPECT_EQ(done, ++watched);
    });
    EXPECT_EQ(watched, 25U);
    EXPECT_EQ(folder.files(), 1U);

    cv::VideoCapture video((folder / "walk.mp4").string());
    ASSERT_TRUE(video.isOpened());
    EXPECT_NEAR(video.get(cv::CAP_PROP_FPS), 30, 0.1);
    cv::Mat before, now;
    int frames = 0;
    while (video.read(now)) {
        ASSERT_EQ(now.size(), film.size);
        if (!before.empty()) {
            EXPECT_GT(cv::norm(before, now, cv::NORM_L1), 100) << frames;
        }
        before = now.clone();
        ++frames;
    }
    EXPECT_EQ(frames, 25);
}

TEST(Video, TakesTheFrameRateAskedFor) {
    Layout layout;
    layout.size = 64;
    layout.fps = 10;
    EXPECT_EQ(animation({walkers(1, 30)}, layout).frames, 10U);
    layout.fps = 60;
    EXPECT_EQ(animation({walkers(1, 30)}, layout).frames, 60U);
}

TEST(Video, FailsWholeOrNotAtAll) {
    const Folder folder;
    const auto motion = walkers(1, 2);
    EXPECT_NE(error_of([&] { render({motion}, {}, folder / "none/a.mp4"); }).find("make it first"),
              std::string::npos);
    EXPECT_NE(error_of([&] { render({motion}, {}, "/proc/a.mp4"); }).find("/proc/a.mp4: cannot be written"),
              std::string::npos);
    EXPECT_NE(error_of([&] { render({walkers(1, 0)}, {}, folder / "a.mp4"); }).find("no frames"),
              std::string::npos);
    Film huge{1, 25, {60002, 60002}, [](std::size_t) { return cv::Mat(); }};
    EXPECT_NE(error_of([&] { write_mp4(folder / "huge.mp4", huge); }).find("smaller --size"),
              std::string::npos);
    EXPECT_EQ(folder.files(), 0U);
}

}  // namespace
}  // namespace actformer::reports
