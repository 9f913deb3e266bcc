// A small renderer of rounded limbs: cones with round ends, lit, hidden one behind another, with smooth
// edges.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "reports/pictures/camera.hpp"

namespace actformer::reports {

/// A limb with round ends, in pixels of the picture; both ends alike make a ball. `colour` is BGR, 0..255.
struct Cone {
    Seen a, b;
    double radius_a = 0, radius_b = 0;
    cv::Vec3f colour;
};

/// Draws `cones` over `picture` (8UC3), each pixel from `samples` x `samples`. Nearer hides farther; where a
/// limb passes well in front of another, a thin gap the colour of `paper` sets them apart; what is far (by
/// nearness) fades towards `paper`.
void draw_solid(cv::Mat& picture, const std::vector<Cone>& cones, int samples, const cv::Vec3f& paper);

}  // namespace actformer::reports
