#include "reports/pictures/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "reports/pictures/samples.hpp"

namespace actformer::reports {
namespace {

/// A corner in sample coordinates of an area.
struct Sampled {
    float x, y, nearness;
};

cv::Rect area_of(const std::vector<MeshCorner>& corners, const cv::Size& size) {
    double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
    for (const auto& c : corners) {
        left = std::min(left, c.at.x - 1);
        right = std::max(right, c.at.x + 2);
        top = std::min(top, c.at.y - 1);
        bottom = std::max(bottom, c.at.y + 2);
    }
    const auto pixel = [](double v, int limit) { return static_cast<int>(std::clamp<double>(v, 0, limit)); };
    const cv::Point corner(pixel(left, size.width), pixel(top, size.height));
    return {corner, cv::Point(std::max(corner.x, pixel(right, size.width)),
                              std::max(corner.y, pixel(bottom, size.height)))};
}

/// Calls `use(row, column, shares of the corners)` for the samples inside a triangle.
template <typename Use>
void for_samples(const std::array<Sampled, 3>& t, const cv::Size& size, Use use) {
    const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [top, bottom] = std::minmax({t[0].y, t[1].y, t[2].y});
    const auto clip = [](float v, int limit) {
        return static_cast<int>(std::clamp(v, -1.0F, static_cast<float>(limit)));
    };
    const float area = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y);
    if (std::fabs(area) < 1e-9F) return;
    constexpr float rounding = -1e-5F;  // neighbours share their edge: a sample on it belongs to both
    for (int row = std::max(0, clip(std::ceil(top), size.height));
         row <= std::min(size.height - 1, clip(bottom, size.height)); ++row)
        for (int column = std::max(0, clip(std::ceil(left), size.width));
             column <= std::min(size.width - 1, clip(right, size.width)); ++column) {
            const auto x = static_cast<float>(column), y = static_cast<float>(row);
            const float b = ((x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (y - t[0].y)) / area;
            const float c = ((t[1].x - t[0].x) * (y - t[0].y) - (x - t[0].x) * (t[1].y - t[0].y)) / area;
            const float a = 1 - b - c;
            if (a >= rounding && b >= rounding && c >= rounding) use(row, column, std::array{a, b, c});
        }
}

cv::Vec3f mixed(const std::array<float, 3>& shares, const cv::Vec3f& a, const cv::Vec3f& b,
                const cv::Vec3f& c) {
    return shares[0] * a + shares[1] * b + shares[2] * c;
}

/// Of length 1, and towards the viewer: of a triangle seen from inside, its back.
cv::Vec3f facing(const cv::Vec3f& normal) {
    const auto length = static_cast<float>(cv::norm(normal));
    if (length < 1e-9F) return {0, 0, 1};
    return normal * ((normal[2] < 0 ? -1 : 1) / length);
}

}  // namespace

void draw_mesh(cv::Mat& picture, const std::vector<MeshCorner>& corners, std::span<const std::uint32_t> faces,
               int samples_per_pixel, const cv::Vec3f& paper) {
    const auto area = area_of(corners, picture.size());
    if (faces.empty() || area.empty()) return;
    Samples samples(area, samples_per_pixel);
    const auto s = static_cast<double>(samples_per_pixel);

    std::vector<Sampled> at;
    double nearest = -1e30, farthest = 1e30;
    for (const auto& c : corners) {
        at.push_back({static_cast<float>((c.at.x - area.x) * s - 0.5),
                      static_cast<float>((c.at.y - area.y) * s - 0.5), static_cast<float>(c.at.nearness)});
        nearest = std::max(nearest, c.at.nearness);
        farthest = std::min(farthest, c.at.nearness);
    }
    const auto fade = [&](float nearness) {
        return nearest > farthest ? static_cast<float>(0.22 * (nearest - nearness) / (nearest - farthest))
                                  : 0.0F;
    };
    for (std::size_t f = 0; f + 2 < faces.size(); f += 3) {
        const auto &a = corners[faces[f]], &b = corners[faces[f + 1]], &c = corners[faces[f + 2]];
        const std::array triangle{at[faces[f]], at[faces[f + 1]], at[faces[f + 2]]};
        for_samples(
            triangle, samples.nearness.size(), [&](int row, int column, const std::array<float, 3>& shares) {
                const float nearness = shares[0] * triangle[0].nearness + shares[1] * triangle[1].nearness +
                                       shares[2] * triangle[2].nearness;
                float& before = samples.nearness.at<float>(row, column);
                if (nearness <= before) return;
                before = nearness;
                const auto colour = mixed(shares, a.colour, b.colour, c.colour);
                const float far = fade(nearness);
                samples.colour.at<cv::Vec3f>(row, column) = lit(
                    colour * (1 - far) + paper * far, facing(mixed(shares, a.normal, b.normal, c.normal)));
            });
    }
    samples.blend_into(picture);
}

}  // namespace actformer::reports
