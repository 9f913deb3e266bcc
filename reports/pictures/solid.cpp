#include "reports/pictures/solid.hpp"

#include <algorithm>
#include <cmath>

#include "reports/pictures/samples.hpp"

namespace actformer::reports {
namespace {

/// A cone in sample coordinates, and what of it the samples ask again and again.
struct SampledBone {
    float ax, ay, az, dx, dy, dz, ra, dr, inverse;

    SampledBone(const Cone& cone, const Samples& samples) {
        const auto s = static_cast<double>(samples.per_pixel);
        const auto at = [&](double v, int corner) { return static_cast<float>((v - corner) * s - 0.5); };
        ax = at(cone.a.x, samples.area.x);
        ay = at(cone.a.y, samples.area.y);
        az = static_cast<float>(cone.a.nearness * s);
        dx = at(cone.b.x, samples.area.x) - ax;
        dy = at(cone.b.y, samples.area.y) - ay;
        dz = static_cast<float>(cone.b.nearness * s) - az;
        ra = static_cast<float>(cone.radius_a * s);
        dr = static_cast<float>(cone.radius_b * s) - ra;
        const float length2 = dx * dx + dy * dy;
        inverse = length2 > 1e-6F ? 1 / length2 : 0;
    }

    /// The nearest point of the axis to (x, y), as 0..1 from a to b.
    float along(float x, float y) const {
        return std::clamp(((x - ax) * dx + (y - ay) * dy) * inverse, 0.0F, 1.0F);
    }
};

/// Calls `use(row, column, offset x, offset y, squared distance, radius, axis nearness)` for the samples
/// within `rim` of the cone.
template <typename Use>
void for_samples(const SampledBone& cone, float rim, const cv::Size& size, Use use) {
    const float most = std::max(cone.ra, cone.ra + cone.dr) + rim;
    const auto clip = [](float v, int limit) {
        return static_cast<int>(std::clamp(v, -1.0F, static_cast<float>(limit)));
    };
    const int left = std::max(0, clip(std::min(cone.ax, cone.ax + cone.dx) - most, size.width));
    const int right =
        std::min(size.width - 1, clip(std::max(cone.ax, cone.ax + cone.dx) + most + 1, size.width));
    const int top = std::max(0, clip(std::min(cone.ay, cone.ay + cone.dy) - most, size.height));
    const int bottom =
        std::min(size.height - 1, clip(std::max(cone.ay, cone.ay + cone.dy) + most + 1, size.height));
    for (int row = top; row <= bottom; ++row)
        for (int column = left; column <= right; ++column) {
            const auto x = static_cast<float>(column), y = static_cast<float>(row);
            const float t = cone.along(x, y);
            const float ox = x - cone.ax - t * cone.dx, oy = y - cone.ay - t * cone.dy;
            const float distance2 = ox * ox + oy * oy, radius = cone.ra + t * cone.dr;
            if (distance2 <= (radius + rim) * (radius + rim))
                use(row, column, ox, oy, distance2, radius, cone.az + t * cone.dz);
        }
}

void fill(Samples& samples, const Cone& cone, const cv::Vec3f& colour) {
    for_samples(SampledBone(cone, samples), 0, samples.nearness.size(),
                [&](int row, int column, float ox, float oy, float distance2, float radius, float axis) {
                    const float rise = std::sqrt(std::max(0.0F, radius * radius - distance2));
                    float& nearest = samples.nearness.at<float>(row, column);
                    if (axis + rise <= nearest) return;
                    nearest = axis + rise;
                    samples.colour.at<cv::Vec3f>(row, column) =
                        lit(colour, {ox / radius, oy / radius, rise / radius});
                });
}

/// Gaps: where `cone` ends in front of something that lies deeper than the limb is thick, a rim of it turns
/// to paper. The limbs that meet it at a joint lie level with it there, and stay.
void part(Samples& samples, const Cone& cone, float rim, const cv::Vec3f& paper) {
    for_samples(SampledBone(cone, samples), rim, samples.nearness.size(),
                [&](int row, int column, float, float, float distance2, float radius, float axis) {
                    if (distance2 < radius * radius) return;
                    const float behind = samples.nearness.at<float>(row, column);
                    if (behind == Samples::nothing || behind > axis - 1.6F * radius) return;
                    samples.colour.at<cv::Vec3f>(row, column) = paper;
                });
}

cv::Rect area_of(const std::vector<Cone>& cones, const cv::Size& size) {
    double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
    for (const auto& c : cones)
        for (const auto& [end, radius] : {std::pair{c.a, c.radius_a}, std::pair{c.b, c.radius_b}}) {
            left = std::min(left, end.x - radius - 3);
            right = std::max(right, end.x + radius + 3);
            top = std::min(top, end.y - radius - 3);
            bottom = std::max(bottom, end.y + radius + 3);
        }
    const auto pixel = [](double v, int limit) { return static_cast<int>(std::clamp<double>(v, 0, limit)); };
    const cv::Point corner(pixel(left, size.width), pixel(top, size.height));
    return {corner, cv::Point(std::max(corner.x, pixel(right + 1, size.width)),
                              std::max(corner.y, pixel(bottom + 1, size.height)))};
}

}  // namespace

void draw_solid(cv::Mat& picture, const std::vector<Cone>& cones, int samples_per_pixel,
                const cv::Vec3f& paper) {
    const auto area = area_of(cones, picture.size());
    if (cones.empty() || area.empty()) return;
    Samples samples(area, samples_per_pixel);

    double nearest = -1e30, farthest = 1e30;
    for (const auto& c : cones) {
        nearest = std::max({nearest, c.a.nearness, c.b.nearness});
        farthest = std::min({farthest, c.a.nearness, c.b.nearness});
    }
    for (const auto& c : cones) {
        const double middle = 0.5 * (c.a.nearness + c.b.nearness);
        const auto fade =
            static_cast<float>(nearest > farthest ? 0.22 * (nearest - middle) / (nearest - farthest) : 0);
        fill(samples, c, c.colour * (1 - fade) + paper * fade);
    }
    const float rim = 1.3F * static_cast<float>(samples_per_pixel);
    for (const auto& c : cones) part(samples, c, rim, paper);
    samples.blend_into(picture);
}

}  // namespace actformer::reports
