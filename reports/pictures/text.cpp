#include "reports/pictures/text.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#ifdef ACTFORMER_FREETYPE
#include <opencv2/freetype.hpp>
#endif

#include "base/text/utf8.hpp"
#include "reports/pictures/style.hpp"

namespace actformer::reports {
namespace {

/// Bytes of the character at `text[i]`, or of a broken one.
std::size_t bytes_at(const std::string& text, std::size_t i) {
    const auto character = first_character(std::string_view(text).substr(i));
    return character ? character->bytes : 1;
}

/// A typeface. One is used at a time: FreeType's faces hold the state of the letter at hand.
class Typeface {
  public:
    explicit Typeface(Weight weight);
    int width(const std::string& text, int size);
    void draw(cv::Mat& picture, const std::string& text, cv::Point at, int size, int rgb);

  private:
    std::mutex mutex_;
#ifdef ACTFORMER_FREETYPE
    cv::Ptr<cv::freetype::FreeType2> face_;
#endif
    bool bold_;
};

#ifdef ACTFORMER_FREETYPE
/// The first typeface that is installed. DejaVu comes with Debian's OpenCV, so pictures look the same from
/// machine to machine.
std::optional<std::string> font_file(Weight weight) {
    namespace fs = std::filesystem;
    static constexpr std::array<std::array<const char*, 2>, 6> files{{
        {"dejavu/DejaVuSans.ttf", "dejavu/DejaVuSans-Bold.ttf"},
        {"liberation/LiberationSans-Regular.ttf", "liberation/LiberationSans-Bold.ttf"},
        {"liberation2/LiberationSans-Regular.ttf", "liberation2/LiberationSans-Bold.ttf"},
        {"noto/NotoSans-Regular.ttf", "noto/NotoSans-Bold.ttf"},
        {"freefont/FreeSans.ttf", "freefont/FreeSansBold.ttf"},
        {"DejaVuSans.ttf", "DejaVuSans-Bold.ttf"},
    }};
    for (const char* folder : {"/usr/share/fonts/truetype", "/usr/share/fonts", "/usr/share/fonts/TTF"})
        for (const auto& file : files) {
            const auto path = fs::path(folder) / file[weight == Weight::bold];
            std::error_code ignored;
            if (fs::is_regular_file(path, ignored)) return path.string();
        }
    return {};
}
#endif

Typeface::Typeface(Weight weight) : bold_(weight == Weight::bold) {
#ifdef ACTFORMER_FREETYPE
    try {
        if (const auto file = font_file(weight)) {
            face_ = cv::freetype::createFreeType2();
            face_->loadFontData(*file, 0);
        }
    } catch (const cv::Exception&) {  // a broken font file: OpenCV's own strokes remain
        face_.release();
    }
#endif
}

/// OpenCV's stroke letters know ASCII alone.
std::string ascii(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); i += bytes_at(text, i))
        out += static_cast<unsigned char>(text[i]) < 0x80 ? std::string(1, text[i])
               : text.compare(i, 3, "…") == 0             ? "..."
                                                          : "?";
    return out;
}

constexpr int stroke_font = cv::FONT_HERSHEY_DUPLEX, stroke_zoom = 4;
double stroke_scale(int size) {
    return size / 30.0 * stroke_zoom;
}

int Typeface::width(const std::string& text, int size) {
    const std::scoped_lock lock(mutex_);
    int baseline = 0;
#ifdef ACTFORMER_FREETYPE
    if (face_) return face_->getTextSize(text, size, -1, &baseline).width;
#endif
    return cv::getTextSize(ascii(text), stroke_font, stroke_scale(size), bold_ ? 6 : 4, &baseline).width /
               stroke_zoom +
           1;
}

void Typeface::draw(cv::Mat& picture, const std::string& text, cv::Point at, int size, int rgb) {
    const std::scoped_lock lock(mutex_);
#ifdef ACTFORMER_FREETYPE
    if (face_) {
        face_->putText(picture, text, at, size, style::scalar(rgb), -1, cv::LINE_AA, true);
        return;
    }
#endif
    int baseline = 0;
    const int thickness = bold_ ? 6 : 4;
    const auto strokes = cv::getTextSize(ascii(text), stroke_font, stroke_scale(size), thickness, &baseline);
    const cv::Rect place(at.x - size, at.y - 2 * size, strokes.width / stroke_zoom + 2 * size, 3 * size);
    const cv::Rect area = place & cv::Rect({0, 0}, picture.size());
    if (area.empty()) return;
    cv::Mat large(area.height * stroke_zoom, area.width * stroke_zoom, CV_8U, cv::Scalar(0)), cover;
    cv::putText(large, ascii(text), (at - area.tl()) * stroke_zoom, stroke_font, stroke_scale(size), 255,
                thickness, cv::LINE_AA);
    cv::resize(large, cover, area.size(), 0, 0, cv::INTER_AREA);
    const auto colour = style::vec(rgb);
    for (int y = 0; y < area.height; ++y)
        for (int x = 0; x < area.width; ++x)
            if (const float c = static_cast<float>(cover.at<std::uint8_t>(y, x)) / 255; c > 0) {
                auto& pixel = picture.at<cv::Vec3b>(area.y + y, area.x + x);
                for (int i = 0; i < 3; ++i)
                    pixel[i] = cv::saturate_cast<std::uint8_t>(static_cast<float>(pixel[i]) * (1 - c) +
                                                               colour[i] * c);
            }
}

Typeface& typeface(Weight weight) {
    static Typeface regular(Weight::regular), bold(Weight::bold);
    return weight == Weight::bold ? bold : regular;
}

}  // namespace

std::string drawable(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const auto character = first_character(text);
        const auto bytes = character ? character->bytes : 1;
        out += character && !is_control(character->code) ? text.substr(0, bytes) : "?";
        text.remove_prefix(bytes);
    }
    return out;
}

int text_width(const std::string& text, int size, Weight weight) {
    return text.empty() ? 0 : typeface(weight).width(text, size);
}

std::string fitted(const std::string& text, int width, int size, Weight weight) {
    // No letter is narrower than an eighth of its height: what is longer than this cannot fit, and need not
    // be measured.
    std::vector<std::size_t> ends{0};
    const auto whole = drawable(text);
    const auto most =
        static_cast<std::size_t>(std::max(0, width)) * 8 / static_cast<std::size_t>(std::max(1, size)) + 1;
    while (ends.back() < whole.size() && ends.size() <= most)
        ends.push_back(ends.back() + bytes_at(whole, ends.back()));
    if (ends.back() == whole.size() && text_width(whole, size, weight) <= width) return whole;

    const auto shortened = [&](std::size_t characters) { return whole.substr(0, ends[characters]) + "…"; };
    std::size_t fits = 0, too_long = ends.size();
    while (too_long - fits > 1) {
        const auto middle = fits + (too_long - fits) / 2;
        (text_width(shortened(middle), size, weight) <= width ? fits : too_long) = middle;
    }
    return fits == 0 ? "" : shortened(fits);
}

void draw_text(cv::Mat& picture, const std::string& text, cv::Point at, int size, int rgb, Weight weight) {
    if (!text.empty()) typeface(weight).draw(picture, drawable(text), at, size, rgb);
}

}  // namespace actformer::reports
