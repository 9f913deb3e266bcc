#include "reports/pictures/contact_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "base/error.hpp"
#include "reports/pictures/draw.hpp"
#include "reports/pictures/style.hpp"
#include "reports/pictures/text.hpp"

namespace actformer::reports {
namespace {

/// Measures that grow with the cells.
struct Measures {
    int margin, title, small, cell_width, cell_height;

    Measures(const std::vector<Stage>& stages, const Layout& layout, double narrowest, double widest) {
        double aspect = narrowest;
        for (const auto& stage : stages) aspect = std::max(aspect, stage.framing().aspect());
        cell_height = layout.size;
        cell_width = std::max(24, static_cast<int>(cell_height * std::min(aspect, widest) + 0.5));
        title = std::clamp(cell_height / 20, 11, 28);
        small = std::clamp(cell_height / 27, 10, 22);
        margin = std::clamp(cell_height / 16, 8, 40);
    }
};

std::vector<Stage> stages_of(const std::vector<JointMotion>& motions, const Layout& layout) {
    if (motions.empty()) throw Error("there is no motion to draw");
    if (layout.size < 40 || layout.size > 4000)
        throw Error("a size of {} pixels; give 40 to 4000", layout.size);
    if (layout.columns < 1 || layout.columns > 100) throw Error("{} columns; give 1 to 100", layout.columns);
    std::vector<Stage> stages;
    stages.reserve(motions.size());
    for (const auto& motion : motions) stages.emplace_back(motion, layout.view, layout.samples);
    return stages;
}

cv::Size limited(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t most = 16384;
    if (width > most || height > most)
        throw Error(
            "the picture would be {} x {} pixels, more than {}; choose a smaller --size, fewer --columns or "
            "fewer motions",
            width, height, most);
    return {static_cast<int>(width), static_cast<int>(height)};
}

cv::Mat blank(const cv::Size& size) {
    return {size, CV_8UC3, style::scalar(style::paper)};
}

void draw_dot(cv::Mat& picture, const cv::Point& centre, double radius, int rgb) {
    const Seen at{static_cast<double>(centre.x), static_cast<double>(centre.y), 0};
    draw_solid(picture, {{at, at, radius, radius, style::vec(rgb)}}, 4, style::vec(style::paper));
}

/// Which colour is whom and which side, from right to left along the baseline at `right_end`.
void draw_legend(cv::Mat& picture, const std::vector<Stage>& stages, cv::Point right_end, int size) {
    std::size_t persons = 0;
    bool sides = false;
    for (const auto& stage : stages) {
        persons = std::max<std::size_t>(persons, stage.motion().persons);
        sides = sides || stage.has_sides();
    }
    if (!sides && persons < 2) return;
    const double radius = 0.36 * size;
    const auto dot = [&](int rgb) {
        right_end.x -= static_cast<int>(radius);
        draw_dot(picture, {right_end.x, right_end.y - static_cast<int>(0.36 * size)}, radius, rgb);
        right_end.x -= static_cast<int>(1.35 * radius);
    };
    const auto label = [&](const std::string& text) {
        right_end.x -= text_width(text, size);
        draw_text(picture, text, right_end, size, style::quiet_ink);
        right_end.x -= size / 3 + 1;
    };
    for (std::size_t p = std::min<std::size_t>(persons, 4); p-- > 0; right_end.x -= size) {
        if (right_end.x < picture.cols / 3) return;
        const auto& body = style::body(p);
        if (persons > 1) {
            label(fmt::format("person {}", p + 1));
            if (sides) dot(body.right);
            dot(body.left);
        } else {
            label("right");
            dot(body.right);
            right_end.x -= size;
            label("left");
            dot(body.left);
        }
    }
}

std::size_t snapshot(const JointMotion& motion, int column, int columns) {
    if (columns == 1) return motion.frames / 2;
    return static_cast<std::size_t>(column) * (motion.frames - 1) / static_cast<std::size_t>(columns - 1);
}

std::string length_of(const JointMotion& motion) {
    return fmt::format("{} frames, {:.2f} s", motion.frames, motion.seconds());
}

void draw_row(cv::Mat& row, const Stage& stage, const Measures& m, int columns) {
    const auto& motion = stage.motion();
    const int width = row.cols - 2 * m.margin, baseline = m.margin + m.title;
    const auto length = length_of(motion);
    const int length_width = text_width(length, m.small);
    const auto title = fitted(motion.title, width - length_width - m.title, m.title, Weight::bold);
    draw_text(row, title, {m.margin, baseline}, m.title, style::ink, Weight::bold);
    const int after = m.margin + text_width(title, m.title, Weight::bold) + (title.empty() ? 0 : m.title);
    if (after + length_width <= m.margin + width)
        draw_text(row, length, {after, baseline}, m.small, style::quiet_ink);

    const int top = baseline + m.title / 2;
    const int shown = std::min<int>(columns, static_cast<int>(std::min<std::uint32_t>(motion.frames, 100)));
    cv::parallel_for_(cv::Range(0, shown), [&](const cv::Range& range) {
        for (int c = range.start; c < range.end; ++c) {
            cv::Mat cell = row(cv::Rect(m.margin + c * m.cell_width, top, m.cell_width, m.cell_height));
            stage.draw(cell, snapshot(motion, c, shown));
        }
    });
    for (int c = 0; c < shown; ++c) {
        const auto time =
            fmt::format("{:.2f} s", static_cast<double>(snapshot(motion, c, shown)) / motion.fps);
        const int x = m.margin + c * m.cell_width + (m.cell_width - text_width(time, m.small)) / 2;
        draw_text(row, time, {x, top + m.cell_height + m.small + m.small / 3}, m.small, style::quiet_ink);
    }
}

/// Sets a title at up to `size`, smaller where that keeps it whole, and cut where even three quarters of it
/// are too large.
void draw_title(cv::Mat& picture, const std::string& title, cv::Point at, int width, int size) {
    const int least = std::max(10, size * 3 / 4);
    auto text = fitted(title, width, size, Weight::bold);
    while (size > least && text != drawable(title)) text = fitted(title, width, --size, Weight::bold);
    draw_text(picture, text, at, size, style::ink, Weight::bold);
}

/// A motion of an animation: title above, the motion, and below it the time and a line that fills as it
/// passes.
void draw_moving(cv::Mat& cell, const Stage& stage, const Measures& m, double seconds) {
    const auto& motion = stage.motion();
    const auto frame = std::min<std::size_t>(
        motion.frames - 1, static_cast<std::size_t>(std::max(0.0, seconds * motion.fps + 1e-6)));
    const int pad = m.margin / 2, baseline = pad + m.title;
    draw_title(cell, motion.title, {pad, baseline}, cell.cols - 2 * pad, m.title);
    const int top = baseline + m.title / 2;
    cv::Mat scene = cell(cv::Rect(0, top, m.cell_width, m.cell_height));
    stage.draw(scene, frame);

    const int line = top + m.cell_height + m.small / 2, thickness = std::max(2, m.cell_height / 160);
    const int right = cell.cols - pad - text_width("00.00 s", m.small) - m.small / 2;
    const auto time = fmt::format("{:.2f} s", static_cast<double>(frame) / motion.fps);
    draw_text(cell, time, {cell.cols - pad - text_width(time, m.small), line + m.small / 2}, m.small,
              style::quiet_ink);
    if (right <= pad) return;
    const double passed = motion.frames > 1 ? static_cast<double>(frame) / (motion.frames - 1) : 1;
    const cv::Rect whole(pad, line, right - pad, thickness);
    cell(whole).setTo(style::scalar(style::rule));
    cell(cv::Rect(pad, line, static_cast<int>(whole.width * passed + 0.5), thickness))
        .setTo(style::scalar(style::body(0).left));
}

/// Columns and rows of an animation's motions.
std::vector<cv::Point> cells_of(const std::vector<JointMotion>& motions, const Layout& layout) {
    const auto near_square = std::ceil(std::sqrt(static_cast<double>(motions.size())));
    const int columns = layout.across > 0 ? layout.across : static_cast<int>(near_square);
    std::vector<cv::Point> cells;
    cv::Point next;
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const bool other_class = layout.across > 0 && i > 0 && motions[i].label != motions[i - 1].label;
        if (other_class || next.x == columns) next = {0, next.y + 1};
        cells.push_back(next);
        ++next.x;
    }
    return cells;
}

}  // namespace

cv::Mat contact_sheet(const std::vector<JointMotion>& motions, const Layout& layout) {
    const auto stages = stages_of(motions, layout);
    const Measures m(stages, layout, 0.5, 1.6);
    std::uint32_t most_frames = 1;
    for (const auto& motion : motions) most_frames = std::max(most_frames, motion.frames);
    const int columns = std::min(layout.columns, static_cast<int>(std::min<std::uint32_t>(most_frames, 100)));

    const int row_height = m.margin + m.title + m.title / 2 + m.cell_height + 2 * m.small;
    const int footer = m.small + m.margin + m.margin / 2;
    const auto rows = static_cast<std::int64_t>(stages.size());
    auto sheet =
        blank(limited(2 * m.margin + std::int64_t{columns} * m.cell_width, rows * row_height + footer));
    for (int r = 0; r < static_cast<int>(rows); ++r) {
        cv::Mat row = sheet.rowRange(r * row_height, (r + 1) * row_height);
        draw_row(row, stages[static_cast<std::size_t>(r)], m, columns);
        if (r > 0) row(cv::Rect(m.margin, 0, sheet.cols - 2 * m.margin, 1)).setTo(style::scalar(style::rule));
    }
    draw_legend(sheet, stages, {sheet.cols - m.margin, sheet.rows - m.margin}, m.small);
    return sheet;
}

Film animation(const std::vector<JointMotion>& motions, const Layout& layout) {
    const auto stages = std::make_shared<const std::vector<Stage>>(stages_of(motions, layout));
    const Measures m(*stages, layout, 0.72, motions.size() == 1 ? 2.0 : 1.4);
    const auto cells = cells_of(motions, layout);
    const int columns = 1 + std::ranges::max(cells, {}, &cv::Point::x).x, rows = 1 + cells.back().y;
    const int height = m.margin / 2 + m.title + m.title / 2 + m.cell_height + 2 * m.small,
              footer = m.small + m.margin;

    Film film;
    film.fps = layout.fps > 0 ? layout.fps : motions[0].fps;
    double seconds = 0;
    for (const auto& motion : motions) seconds = std::max(seconds, motion.seconds());
    if (seconds * film.fps > 1e6)
        throw Error("the animation would have {:.0f} frames, more than a million; choose a lower --fps",
                    seconds * film.fps);
    film.frames = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(seconds * film.fps)));
    const auto even = [](std::int64_t v) { return v + v % 2; };
    film.size =
        limited(even(std::int64_t{columns} * m.cell_width), even(std::int64_t{rows} * height + footer));
    film.draw = [stages, m, cells, height, size = film.size, fps = film.fps](std::size_t frame) {
        auto picture = blank(size);
        for (std::size_t i = 0; i < stages->size(); ++i) {
            const cv::Point at(cells[i].x * m.cell_width, cells[i].y * height);
            cv::Mat cell = picture(cv::Rect(at, cv::Size(m.cell_width, height)));
            draw_moving(cell, (*stages)[i], m, static_cast<double>(frame) / fps);
        }
        draw_legend(picture, *stages, {size.width - m.margin / 2, size.height - m.margin / 2}, m.small);
        return picture;
    };
    return film;
}

}  // namespace actformer::reports
