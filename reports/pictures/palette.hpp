// The few colours that stand for many.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace actformer::reports {

/// At most `most` colours for the pixels of `pictures` (8UC3), by median cut. The first is the most common,
/// exactly.
std::vector<cv::Vec3b> median_cut(const std::vector<cv::Mat>& pictures, std::size_t most);

/// Finds the nearest colour of a palette of up to 256 entries. Remembers what it found.
class Palette {
  public:
    explicit Palette(std::vector<cv::Vec3b> colours);
    const std::vector<cv::Vec3b>& colours() const { return colours_; }
    std::uint8_t nearest(const cv::Vec3b& colour);

  private:
    std::vector<cv::Vec3b> colours_;
    std::vector<std::int16_t> known_;  ///< by colour at 7 bits a channel; -1 where not asked for yet
};

}  // namespace actformer::reports
