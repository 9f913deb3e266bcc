// Motions laid out on paper: a row of snapshots each, or all of them moving side by side.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "reports/motions/joint_motion.hpp"
#include "reports/pictures/camera.hpp"
#include "reports/pictures/film.hpp"

namespace actformer::reports {

struct Layout {
    View view;
    int size = 320;   ///< height of a motion's cell in pixels, 40 .. 4000
    int columns = 8;  ///< snapshots a motion on a contact sheet, 1 .. 100
    int across = 0;   ///< most motions in a row of an animation, all of a class; 0: near-square, of any
    double fps = 0;   ///< of an animation; 0: as the first motion
    int samples = 3;  ///< a body's pixels are made from samples x samples each
};

/// The contact sheet: a row a motion, snapshots evenly over time from left to right. 8UC3, BGR. Throws Error
/// where there is no motion, one cannot be drawn (see check()), or the sheet would be more than 16384 pixels
/// wide or high.
cv::Mat contact_sheet(const std::vector<JointMotion>& motions, const Layout& layout);

/// All motions at once, in the cells of a grid; it lasts as long as the longest, and a shorter one
/// holds its last pose. Width and height are even. Keeps references to `motions`. Throws Error as
/// contact_sheet() does.
Film animation(const std::vector<JointMotion>& motions, const Layout& layout);

}  // namespace actformer::reports
