#include "reports/pictures/samples.hpp"

#include <algorithm>

namespace actformer::reports {

void Samples::blend_into(cv::Mat& picture) const {
    const int s = per_pixel;
    const float each = 1.0F / static_cast<float>(s * s);
    for (int y = 0; y < area.height; ++y)
        for (int x = 0; x < area.width; ++x) {
            cv::Vec3f sum(0, 0, 0);
            int covered = 0;
            for (int v = y * s; v < y * s + s; ++v) {
                const float* near_row = nearness.ptr<float>(v);
                const auto* colour_row = colour.ptr<cv::Vec3f>(v);
                for (int u = x * s; u < x * s + s; ++u)
                    if (near_row[u] != nothing) {
                        sum += colour_row[u];
                        ++covered;
                    }
            }
            if (covered == 0) continue;
            auto& pixel = picture.at<cv::Vec3b>(area.y + y, area.x + x);
            const float rest = 1 - static_cast<float>(covered) * each;
            for (int c = 0; c < 3; ++c)
                pixel[c] =
                    cv::saturate_cast<std::uint8_t>(sum[c] * each + rest * static_cast<float>(pixel[c]));
        }
}

cv::Vec3f lit(const cv::Vec3f& colour, const cv::Vec3f& normal) {
    const float towards_light = std::max(0.0F, -0.38F * normal[0] - 0.55F * normal[1] + 0.744F * normal[2]);
    const float edge = std::min(1.0F, normal[2] / 0.45F);
    const float shade = (0.70F + 0.34F * towards_light) * (0.80F + 0.20F * edge * (2 - edge));
    const float gleam = 22 * towards_light * towards_light * towards_light * towards_light;
    cv::Vec3f out;
    for (int c = 0; c < 3; ++c) out[c] = std::min(255.0F, colour[c] * shade + gleam);
    return out;
}

}  // namespace actformer::reports
