// What a user should know of BVH and AMC files as a whole, each doubt with the option that mends it.
#pragma once

#include <string>
#include <vector>

#include "ingest/dataset/topology.hpp"
#include "ingest/formats/bvh/bvh_survey.hpp"

namespace actformer::ingest {

/// Which joint is the root, and of how many.
std::string root_remark(const Topology& topology, const Recording& example);

/// `others` are files of another skeleton than that of `files` files.
std::string skeleton_remark(std::size_t files, const std::vector<std::string>& others);

/// Heights and the axis up.
class Doubts {
  public:
    Doubts(const std::vector<const SurveyedFile*>& files, Up up);

    /// Of a body that stands, in the files' units: the median over the files.
    double height() const { return height_; }

    /// `found`: the scale was found from the height.
    std::vector<std::string> remarks(double scale, bool found) const;

  private:
    std::string height_remark(double scale, bool found) const;
    std::string size_remark() const;
    std::string up_remark() const;

    std::vector<const SurveyedFile*> files_;
    Up up_;                       ///< as the options have it
    std::optional<Up> found_up_;  ///< where bodies do not point up: where they point
    double height_ = 0, size_ = 0;
};

}  // namespace actformer::ingest
