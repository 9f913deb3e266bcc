// Motions for the tests: bodies that walk on the spot, in numbers anyone can follow.
#pragma once

#include <stdlib.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>

#include "ingest/dataset/described_motions.hpp"
#include "reports/motions/joint_motion.hpp"

namespace actformer::reports::testing {

/// `persons` adults with NTU's joints, 1.2 m apart along x, facing +z (so their left is towards +x), swinging
/// arms and legs.
inline JointMotion walkers(std::uint32_t persons, std::uint32_t frames, double fps = 30) {
    JointMotion motion{"walk · S001C001P001R001A001", ingest::ntu25(), persons, frames, fps, {}, {}, {}};
    const auto lengths = ingest::usual_bone_lengths(motion.topology);
    for (std::uint32_t t = 0; t < frames; ++t)
        for (std::uint32_t p = 0; p < persons; ++p) {
            const double swing = 0.6 * std::sin(0.25 * t + p);
            std::array<cv::Vec3d, 25> at{};
            for (const auto j : motion.topology.order()) {
                const auto& name = motion.topology.names[j];
                const bool left = name.starts_with("left");
                const bool arm = (j >= 5 && j <= 7) || (j >= 9 && j <= 11) || j >= 21,
                           leg = j >= 12 && j <= 19;
                cv::Vec3d limb(0, 1, 0);
                if (j == 4 || j == 8 || j == 12 || j == 16) {
                    limb = cv::Vec3d(left ? 1 : -1, -0.1, 0);
                } else if (arm) {
                    limb = cv::Vec3d(left ? 0.2 : -0.2, -1, left ? -swing : swing);
                } else if (leg) {
                    limb = name.ends_with("foot") ? cv::Vec3d(0, -0.2, 1)
                                                  : cv::Vec3d(0, -1, left ? swing : -swing);
                }
                const int parent = motion.topology.parents[j];
                at[j] = parent < 0 ? cv::Vec3d(1.2 * p, 0.95, 0)
                                   : at[parent] + limb * (lengths[j] / cv::norm(limb));
            }
            for (const auto& x : at)
                for (int d = 0; d < 3; ++d) motion.joints.push_back(static_cast<float>(x[d]));
        }
    return motion;
}

/// A fresh folder that goes away with the test.
class Folder {
  public:
    Folder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "actformer-reports-XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
        path_ = pattern;
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    std::size_t files() const {
        const std::filesystem::directory_iterator all(path_);
        return static_cast<std::size_t>(std::distance(begin(all), end(all)));
    }

  private:
    std::filesystem::path path_;
};

/// The message that `what` throws; empty where it throws nothing.
template <typename What>
std::string error_of(What what) {
    try {
        what();
    } catch (const std::exception& e) {
        return e.what();
    }
    return "";
}

/// The share of pixels that differ between two pictures.
inline double difference(const cv::Mat& a, const cv::Mat& b) {
    std::size_t differing = 0;
    for (int y = 0; y < a.rows; ++y)
        for (int x = 0; x < a.cols; ++x) differing += a.at<cv::Vec3b>(y, x) != b.at<cv::Vec3b>(y, x);
    return static_cast<double>(differing) / static_cast<double>(a.total());
}

}  // namespace actformer::reports::testing
