// Where a motion is seen from, and how large: an orthographic camera that keeps its scale over time.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "reports/motions/joint_motion.hpp"

namespace actformer::reports {

/// Degrees. Azimuth 0 looks the persons in the face and grows as the camera walks to their left; elevation 90
/// looks straight down.
struct View {
    double azimuth = 28, elevation = 14;
    bool orbit = false;  ///< the camera walks once around over the length of the motion
};

/// Views that have a name: front, side, ...
std::vector<std::string> view_names();

/// A name of view_names(), or "AZ,EL" in degrees. Throws Error listing these.
View parse_view(const std::string& text);

/// A world point as the camera sees it: pixels from the cell's corner (y down), and pixels nearer to the
/// viewer.
struct Seen {
    double x = 0, y = 0, nearness = 0;
};

/// The camera of one frame.
class Camera {
  public:
    Camera(cv::Vec3d toward, cv::Vec3d right) : right_(right), up_(toward.cross(right)), toward_(toward) {}

    Seen project(const cv::Vec3d& world) const {
        const cv::Vec3d d = world - centre_;
        return {offset_.x + scale_ * right_.dot(d), offset_.y - scale_ * up_.dot(d), scale_ * toward_.dot(d)};
    }

    /// A direction of the world: right, down and towards the viewer.
    cv::Vec3d turned(const cv::Vec3d& direction) const {
        return {right_.dot(direction), -up_.dot(direction), toward_.dot(direction)};
    }

    /// The point of the plane y = `height` that is seen at `pixel`. Needs a camera above it (rise() > 0).
    cv::Vec3d on_floor(cv::Point2d pixel, double height) const;

    double scale() const { return scale_; }              ///< pixels a metre
    double rise() const { return toward_[1]; }           ///< sine of the elevation
    const cv::Vec3d& centre() const { return centre_; }  ///< the point of the world that is kept in its place
    const cv::Vec3d& right() const { return right_; }

    void place(const cv::Vec3d& centre, double scale, cv::Point2d offset) {
        centre_ = centre;
        scale_ = scale;
        offset_ = offset;
    }

  private:
    cv::Vec3d right_, up_, toward_, centre_{0, 0, 0};
    double scale_ = 1;
    cv::Point2d offset_{0, 0};
};

/// How a motion is framed: one camera a frame, all of one scale.
class Framing {
  public:
    /// Looks at `motion` so that the whole motion fits. A joint that flies off for a moment does not shrink
    /// everything else. Where the persons travel far, the camera goes along with them.
    Framing(const JointMotion& motion, const View& view);

    /// Width to height of what is to be seen.
    double aspect() const { return box_.width / box_.height; }

    /// The camera of `frame` for pictures in which the motion fills `inside`.
    Camera camera(std::size_t frame, const cv::Rect2d& inside) const;

    double floor() const { return floor_; }              ///< height in metres
    const cv::Vec3d& facing() const { return facing_; }  ///< horizontal; where azimuth 0 looks from
    double reach() const { return reach_; }  ///< metres from the root to the furthest tip, along the limbs
    bool follows() const { return follows_; }

  private:
    Camera oriented(std::size_t frame) const;
    cv::Rect2d extent(const JointMotion& motion) const;
    cv::Rect2d with_room(cv::Rect2d joints, const JointMotion& motion) const;

    View view_;
    std::size_t frames_;
    cv::Vec3d facing_;
    double floor_ = 0, reach_ = 1;
    bool follows_ = false;
    std::vector<cv::Vec3d> centres_;  ///< (frames)
    cv::Rect2d box_;  ///< metres, on the picture plane, relative to the projected centre; y up
};

/// (persons, K) metres: each limb's median over the visible frames.
std::vector<double> limb_lengths(const JointMotion& motion);

/// Which side of the body a joint's name says it is on.
enum class Side { middle, left, right };
Side side_of(const std::string& joint_name);

}  // namespace actformer::reports
