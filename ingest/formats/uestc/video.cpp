#include "ingest/formats/uestc/video.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/text/lettered_number.hpp"

namespace actformer::ingest::uestc {
namespace {

constexpr std::array train_subjects{1,  2,  6,  12, 13, 16,  21,  24,  28,  29,  30,  31, 33,
                                    35, 39, 41, 42, 45, 47,  50,  52,  54,  55,  57,  59, 61,
                                    63, 64, 67, 69, 70, 71,  73,  77,  81,  84,  86,  87, 88,
                                    90, 91, 93, 96, 99, 102, 103, 104, 107, 108, 112, 113};

constexpr int going_round = 8;
constexpr double half_picture = 270, focal_length = 500;  // pixels

/// The diagonal of the box about points (count) in a plane.
template <typename Point>
double diagonal(std::size_t count, Point point) {
    constexpr double far = std::numeric_limits<double>::infinity();
    std::array<double, 2> low{far, far}, high{-far, -far};
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t d = 0; d < 2; ++d) {
            low[d] = std::min(low[d], point(i, d));
            high[d] = std::max(high[d], point(i, d));
        }
    return std::hypot(high[0] - low[0], high[1] - low[1]);
}

}  // namespace

std::optional<Quaternion> VideoName::to_front() const {
    if (side == 1) return Quaternion{};
    if (view == going_round) return {};
    const double half = -view * std::numbers::pi / 8;
    return Quaternion{std::cos(half), 0, std::sin(half), 0};
}

std::optional<VideoName> parse_video_name(std::string_view name) {
    std::array<int, 4> numbers{};
    constexpr std::string_view letters = "adpc";
    for (std::size_t i = 0; i < letters.size(); ++i) {
        numbers[i] = take_number<int>(name, letters[i]).value_or(-1);
        if (numbers[i] < 0 || !name.starts_with('_')) return {};
        name.remove_prefix(1);
    }
    const auto& [action, view, subject, side] = numbers;
    if (name != "color.avi" || view > going_round) return {};
    return VideoName{static_cast<std::uint32_t>(action), view, subject, side};
}

bool trains(int subject) {
    return std::binary_search(train_subjects.begin(), train_subjects.end(), subject);
}

std::vector<double> trajectory(const NumpyRows& cameras, const NumpyRows& joints, std::uint64_t frames) {
    std::vector<double> out, body(joints.size());
    out.reserve(3 * frames);
    for (std::uint64_t t = 0; t < frames; ++t) {
        std::array<double, 4> camera{};
        cameras.read(t, camera.data());
        joints.read(t, body.data());
        const double scale = camera[0], *shift = &camera[2];
        const auto count = body.size() / 3;
        const double metres = diagonal(count, [&](std::size_t i, std::size_t d) { return body[3 * i + d]; });
        const double pixels = diagonal(count, [&](std::size_t i, std::size_t d) {
            return (scale * (body[3 * i + d] + shift[d]) + 1) * half_picture;
        });
        out.insert(out.end(), {shift[0], shift[1], focal_length * (metres / pixels)});
    }
    return out;
}

}  // namespace actformer::ingest::uestc
