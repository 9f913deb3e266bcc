// One motion in one cell of a picture: floor, shadow and bodies.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "reports/motions/joint_motion.hpp"
#include "reports/pictures/camera.hpp"
#include "reports/pictures/solid.hpp"

namespace actformer::reports {

/// Draws the frames of one motion. Drawing is safe from many threads at once.
class Stage {
  public:
    /// Throws Error as check(motion) does. `samples` x `samples` decide each pixel of a body.
    Stage(const JointMotion& motion, const View& view, int samples = 3);

    const JointMotion& motion() const { return motion_; }
    const Framing& framing() const { return framing_; }
    bool has_sides() const { return has_sides_; }  ///< left and right are known

    /// Draws `frame` into `cell` (8UC3, already the colour of paper). Every joint is inside, save one that
    /// flew off.
    void draw(cv::Mat& cell, std::size_t frame) const;

    /// The camera that draw() uses for a cell of this size.
    Camera camera(std::size_t frame, const cv::Size& cell) const;

  private:
    std::vector<Cone> limbs(const Camera& camera, std::size_t frame) const;
    void draw_skin(cv::Mat& cell, const Camera& camera, std::size_t frame) const;
    cv::Vec3f colour(std::size_t person, Side side) const;
    void draw_floor(cv::Mat& cell, const Camera& camera) const;
    void draw_shadow(cv::Mat& cell, const Camera& camera, std::size_t frame) const;

    JointMotion motion_;
    Framing framing_;
    int samples_;
    bool has_sides_ = false;
    std::vector<Side> sides_;            ///< (K)
    int head_ = -1;                      ///< joint
    int crown_ = -1;                     ///< the head's own tip, where there is one
    std::vector<double> radius_;         ///< (persons, K) metres, at the joint
    std::vector<cv::Vec3f> skin_sides_;  ///< (V) shares of middle, left and right; empty without a skin
};

}  // namespace actformer::reports
