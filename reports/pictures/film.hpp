// Moving pictures before they are a file.
#pragma once

#include <cstddef>
#include <functional>
#include <opencv2/core.hpp>

namespace actformer::reports {

/// Frames that are drawn when they are asked for, from many threads at once.
struct Film {
    std::size_t frames = 0;
    double fps = 30;
    cv::Size size;
    std::function<cv::Mat(std::size_t)> draw;  ///< 8UC3, BGR, of `size`
};

/// Called with frames written and frames in all.
using Watcher = std::function<void(std::size_t, std::size_t)>;

/// Draws every frame, as many at once as there are processors, and hands them to `use` in order.
void for_each_frame(const Film& film, const std::function<void(std::size_t, const cv::Mat&)>& use);

}  // namespace actformer::reports
