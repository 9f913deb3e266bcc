#include "reports/pictures/render.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/lower_case.hpp"
#include "base/text/printable.hpp"
#include "base/text/suggestion.hpp"
#include "reports/pictures/gif.hpp"
#include "reports/pictures/video.hpp"

namespace actformer::reports {

PictureKind picture_kind(const std::filesystem::path& path) {
    const auto extension = lower_case(path.extension().string());
    if (extension == ".png") return PictureKind::png;
    if (extension == ".gif") return PictureKind::gif;
    if (extension == ".mp4") return PictureKind::mp4;
    throw Error(
        "cannot tell what to draw from '{}': give a name that ends in .png (contact sheet), .gif or .mp4{}",
        path.string(), suggestion(extension, {".png", ".gif", ".mp4"}));
}

void write_png(const std::filesystem::path& path, const cv::Mat& picture) {
    std::vector<std::uint8_t> bytes;
    if (!cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9}))
        throw Error("cannot write {}: OpenCV was built without PNG; install libopencv-dev", path.string());
    write_whole(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void render(const std::vector<JointMotion>& motions, const Layout& layout, const std::filesystem::path& path,
            const Watcher& watch) try {
    switch (picture_kind(path)) {
        case PictureKind::png:
            write_png(path, contact_sheet(motions, layout));
            break;
        case PictureKind::gif:
            write_gif(path, animation(motions, layout), watch);
            break;
        case PictureKind::mp4:
            write_mp4(path, animation(motions, layout), watch);
            break;
    }
} catch (const cv::Exception& e) {
    throw Error("{}: cannot be drawn: {}; choose a smaller --size, or fewer motions", path.string(),
                printable(e.err));
}

}  // namespace actformer::reports
