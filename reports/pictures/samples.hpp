// What of a picture is nearest, several samples a pixel, and how it is lit.
#pragma once

#include <limits>
#include <opencv2/core.hpp>

namespace actformer::reports {

/// The samples over one rectangle of the picture.
struct Samples {
    static constexpr float nothing = -std::numeric_limits<float>::infinity();

    cv::Rect area;  ///< in pixels
    int per_pixel;
    cv::Mat nearness;  ///< 32F, `nothing` where there is only paper
    cv::Mat colour;    ///< 32FC3

    Samples(const cv::Rect& rect, int samples)
        : area(rect),
          per_pixel(samples),
          nearness(rect.height * samples, rect.width * samples, CV_32F, cv::Scalar(nothing)),
          colour(nearness.size(), CV_32FC3) {}

    /// The mean of a pixel's samples, over what `picture` (8UC3) has where some of them are nothing.
    void blend_into(cv::Mat& picture) const;
};

/// A colour under light from the upper left, over the viewer's shoulder; the rim a little darker, which draws the outline. The
/// surface's normal points right, down and towards the viewer, and has length 1.
cv::Vec3f lit(const cv::Vec3f& colour, const cv::Vec3f& normal);

}  // namespace actformer::reports
