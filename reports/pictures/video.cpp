#include "reports/pictures/video.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

#include "base/error.hpp"
#include "base/files/aside.hpp"
#include "base/files/scratch.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;

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

/// A film in memory. OpenCV goes by a file's name and does not say when a write fails, as on a full disk: it is given a link to memory.
class FilmInMemory {
  public:
    FilmInMemory()
        : folder_("film"), file_(::memfd_create("film", MFD_CLOEXEC)), link_(folder_.path() / "film.mp4") {
        std::error_code error;
        fs::create_symlink(fmt::format("/proc/self/fd/{}", file_.get()), link_, error);
        if (file_.get() < 0 || error)
            throw Error("{}: no film can be made in memory: {}; write .gif", link_.string(),
                        error ? error.message() : reason());
    }

    const fs::path& path() const { return link_; }

    void copy_to(Aside& to) const {
        if (::lseek(file_.get(), 0, SEEK_SET) != 0)
            throw Error("{}: cannot be read: {}", link_.string(), reason());
        std::vector<char> piece(std::size_t{1} << 20);
        while (const auto got = read_fully(file_.get(), piece.data(), piece.size(), link_))
            to.write({piece.data(), got});
    }

  private:
    Scratch folder_;
    Descriptor file_;
    fs::path link_;
};

/// Whether memory ran out is not said either: ask the finished film.
std::size_t frames_in(const std::filesystem::path& path) {
    const cv::VideoCapture video(path.string(), cv::CAP_FFMPEG);
    return video.isOpened()
               ? static_cast<std::size_t>(std::max(0.0, video.get(cv::CAP_PROP_FRAME_COUNT) + 0.5))
               : 0;
}

}  // namespace

void write_mp4(const std::filesystem::path& path, const Film& film, const Watcher& watch) {
    silence_libraries();
    Aside file(path);
    const FilmInMemory made;
    auto writer = open(made.path(), film);
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
    if (frames_in(made.path()) != film.frames)
        throw Error("cannot make all of {}; is there enough memory?", path.string());
    made.copy_to(file);
    file.commit();
}

}  // namespace actformer::reports
