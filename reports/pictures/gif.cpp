#include "reports/pictures/gif.hpp"

#include <gif_lib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "base/error.hpp"
#include "base/files/aside.hpp"
#include "reports/pictures/palette.hpp"

namespace actformer::reports {
namespace {

constexpr int transparent = 255;

/// giflib's encoder on a file; every failure is an Error.
class Encoder {
  public:
    Encoder(Aside& file, const cv::Size& size, const std::vector<cv::Vec3b>& colours) : file_(file) {
        int code = 0;
        gif_ = EGifOpen(&file_, write, &code);
        if (gif_ == nullptr) throw Error("cannot write {}: {}", file_.path().string(), GifErrorString(code));
        EGifSetGifVersion(gif_, true);

        std::array<GifColorType, 256> map{};
        for (std::size_t i = 0; i < colours.size(); ++i)
            map[i] = {colours[i][2], colours[i][1], colours[i][0]};
        const std::unique_ptr<ColorMapObject, decltype(&GifFreeMapObject)> palette(
            GifMakeMapObject(256, map.data()), GifFreeMapObject);
        need(palette ? EGifPutScreenDesc(gif_, size.width, size.height, 8, 0, palette.get()) : GIF_ERROR);
        loop_for_ever();
    }
    ~Encoder() {
        if (gif_ != nullptr) EGifCloseFile(gif_, nullptr);
    }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    /// One picture of palette entries over `area`, shown for `centiseconds`.
    void add(const cv::Mat& indices, const cv::Rect& area, int centiseconds) {
        GraphicsControlBlock control{};
        control.DisposalMode = DISPOSE_DO_NOT;
        control.UserInputFlag = false;
        control.DelayTime = centiseconds;
        control.TransparentColor = transparent;
        std::array<GifByteType, 4> bytes{};
        EGifGCBToExtension(&control, bytes.data());
        need(EGifPutExtension(gif_, GRAPHICS_EXT_FUNC_CODE, 4, bytes.data()));
        need(EGifPutImageDesc(gif_, area.x, area.y, area.width, area.height, false, nullptr));
        std::vector<GifPixelType> line(static_cast<std::size_t>(area.width));
        for (int y = area.y; y < area.y + area.height; ++y) {
            std::copy_n(indices.ptr<std::uint8_t>(y) + area.x, area.width,
                        line.begin());  // giflib masks it in place
            need(EGifPutLine(gif_, line.data(), area.width));
        }
    }

    void finish() {
        int code = 0;
        auto* gif = std::exchange(gif_, nullptr);
        const auto closed = EGifCloseFile(gif, &code);
        file_.check();
        if (closed == GIF_ERROR)
            throw Error("cannot finish {}: {}", file_.path().string(), GifErrorString(code));
    }

  private:
    /// giflib is C, and drops failures now and then: the file remembers them.
    static int write(GifFileType* gif, const GifByteType* bytes, int count) {
        try {
            static_cast<Aside*>(gif->UserData)
                ->write({reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(count)});
            return count;
        } catch (const Error&) {
            return 0;
        }
    }

    void need(int result) const {
        file_.check();
        if (result == GIF_ERROR)
            throw Error("cannot write {}: {}", file_.path().string(), GifErrorString(gif_->Error));
    }

    void loop_for_ever() {
        static constexpr std::array<GifByteType, 3> forever{1, 0, 0};
        need(EGifPutExtensionLeader(gif_, APPLICATION_EXT_FUNC_CODE));
        need(EGifPutExtensionBlock(gif_, 11, "NETSCAPE2.0"));
        need(EGifPutExtensionBlock(gif_, 3, forever.data()));
        need(EGifPutExtensionTrailer(gif_));
    }

    Aside& file_;
    GifFileType* gif_ = nullptr;
};

/// `film` with no more frames a second than GIF can show.
Film slow_enough(const Film& film) {
    if (film.fps <= most_gif_fps) return film;
    Film slow = film;
    slow.fps = most_gif_fps;
    slow.frames = std::max<std::size_t>(
        1, static_cast<std::size_t>(static_cast<double>(film.frames) * most_gif_fps / film.fps));
    slow.draw = [draw = film.draw, last = film.frames - 1, step = film.fps / most_gif_fps](std::size_t i) {
        return draw(std::min(last, static_cast<std::size_t>(std::lround(static_cast<double>(i) * step))));
    };
    return slow;
}

std::vector<cv::Vec3b> colours_of(const Film& film) {
    std::vector<cv::Mat> pictures;
    const std::size_t looks = std::min<std::size_t>(film.frames, 8);
    for (std::size_t i = 0; i < looks; ++i) pictures.push_back(film.draw(i * film.frames / looks));
    return median_cut(pictures, transparent);
}

/// What differs between two pictures of palette entries; one pixel where nothing does, since a GIF's frame
/// cannot be empty.
cv::Rect changed(const cv::Mat& before, const cv::Mat& now) {
    int left = now.cols, right = -1, top = now.rows, bottom = -1;
    for (int y = 0; y < now.rows; ++y)
        for (int x = 0; x < now.cols; ++x)
            if (before.at<std::uint8_t>(y, x) != now.at<std::uint8_t>(y, x)) {
                left = std::min(left, x);
                right = std::max(right, x);
                top = std::min(top, y);
                bottom = y;
            }
    return right < 0 ? cv::Rect(0, 0, 1, 1) : cv::Rect(left, top, right - left + 1, bottom - top + 1);
}

}  // namespace

void write_gif(const std::filesystem::path& path, const Film& whole, const Watcher& watch) {
    const auto film = slow_enough(whole);
    Aside file(path);
    Palette palette(colours_of(film));
    Encoder encoder(file, film.size, palette.colours());

    cv::Mat before, now(film.size, CV_8U), stored(film.size, CV_8U);
    for_each_frame(film, [&](std::size_t i, const cv::Mat& picture) {
        for (int y = 0; y < picture.rows; ++y)
            for (int x = 0; x < picture.cols; ++x) {
                const auto entry = palette.nearest(picture.at<cv::Vec3b>(y, x));
                now.at<std::uint8_t>(y, x) = entry;
                const bool same = !before.empty() && before.at<std::uint8_t>(y, x) == entry;
                stored.at<std::uint8_t>(y, x) = same ? transparent : entry;
            }
        // Delays are rounded as a sum, so that 30 frames take a second and not 30 times 0.03 s.
        const auto shown_at = [&](std::size_t n) {
            return std::lround(100 * static_cast<double>(n) / film.fps);
        };
        const auto area = before.empty() ? cv::Rect({0, 0}, film.size) : changed(before, now);
        encoder.add(stored, area, static_cast<int>(std::clamp(shown_at(i + 1) - shown_at(i), 1L, 65535L)));
        before = now.clone();
        if (watch) watch(i + 1, film.frames);
    });
    encoder.finish();
    file.commit();
}

}  // namespace actformer::reports
