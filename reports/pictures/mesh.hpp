// A renderer of meshes: triangles, lit by the normals of their corners, hidden one behind another, with smooth edges.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "reports/pictures/camera.hpp"

namespace actformer::reports {

struct MeshCorner {
    Seen at;           ///< in pixels of the picture
    cv::Vec3f normal;  ///< right, down, towards the viewer
    cv::Vec3f colour;  ///< BGR, 0 .. 255
};

/// Draws triangles (three corners each) over `picture` (8UC3), each pixel from `samples` x `samples`. Both sides of a triangle show.
/// What is far (by nearness) fades towards `paper`.
void draw_mesh(cv::Mat& picture, const std::vector<MeshCorner>& corners, std::span<const std::uint32_t> faces,
               int samples, const cv::Vec3f& paper);

}  // namespace actformer::reports
