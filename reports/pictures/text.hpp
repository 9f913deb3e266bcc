// Lettering.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <string_view>

namespace actformer::reports {

enum class Weight { regular, bold };

/// `text` as UTF-8 that can be set on one line: broken bytes and control characters become '?'.
std::string drawable(std::string_view text);

/// Width in pixels of `text` set `size` pixels high (line height without leading).
int text_width(const std::string& text, int size, Weight weight = Weight::regular);

/// `text`, or its beginning with an ellipsis where it is wider than `width` pixels.
std::string fitted(const std::string& text, int width, int size, Weight weight = Weight::regular);

/// Sets `text` on `picture` (8UC3) with its baseline beginning at `at`. `rgb` as 0xRRGGBB. Safe from many
/// threads.
void draw_text(cv::Mat& picture, const std::string& text, cv::Point at, int size, int rgb,
               Weight weight = Weight::regular);

}  // namespace actformer::reports
