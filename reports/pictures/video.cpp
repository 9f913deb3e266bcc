#include "reports/pictures/video.hpp"

#include <cstdlib>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

#include "base/error.hpp"
#include "base/files/aside.hpp"

namespace actformer::reports {
namespace {

/// FFmpeg and its encoders report to standard error as they please; this must come before OpenCV first calls
/// them.
void silence_libraries() {
    setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

cv::VideoWriter open(const std::filesystem::path& path, const Film& film) {
    cv::VideoWriter writer;
    for (const char* codec : {"avc1", "mp4v"}) {
        const int code = cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]);
        try {
            if (writer.open(path.string(), cv::CAP_FFMPEG, code, film.fps, film.size)) break;
        } catch (const cv::Exception&) {  // this codec is not to be had
        }
    }
    return writer;
}

/// OpenCV does not say when a write fails (a full disk): ask the finished file.
std::size_t frames_in(const std::filesystem::path& path) {
    const cv::VideoCapture video(path.string(), cv::CAP_FFMPEG);
    return video.isOpened()
               ? static_cast<std::size_t>(std::max(0.0, video.get(cv::CAP_PROP_FRAME_COUNT) + 0.5))
               : 0;
}

}  // namespace

void write_mp4(const std::filesystem::path& path, const Film& film, const Watcher& watch) {
    silence_libraries();
    Aside file(path, path.extension().string());
    auto writer = open(file.partial(), film);
    if (!writer.isOpened())
        throw Error(
            "cannot write {} at {} x {} pixels: OpenCV was built without an encoder for it; choose a smaller "
            "--size, or "
            "write .gif",
            path.string(), film.size.width, film.size.height);
    for_each_frame(film, [&](std::size_t i, const cv::Mat& picture) {
        writer.write(picture);
        if (watch) watch(i + 1, film.frames);
    });
    writer.release();
    if (frames_in(file.partial()) != film.frames)
        throw Error("cannot write all of {}; is the disk full?", path.string());
    file.commit();
}

}  // namespace actformer::reports
