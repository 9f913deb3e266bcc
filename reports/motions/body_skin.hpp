// A body model to draw rotations of SMPL's joints with.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include "ingest/dataset/motion.hpp"
#include "ingest/smpl/body_file.hpp"

namespace actformer::reports {

/// The mean body of a model's file, on the device that the program takes unless told otherwise. Calls may come from many threads.
class BodySkin {
  public:
    /// Throws Error as read_smpl_body does.
    explicit BodySkin(const std::filesystem::path& file);

    const ingest::SmplBody& body() const { return body_; }

    /// (persons, V, 3) metres of one frame of rot6d motion of SMPL's joints.
    std::vector<float> vertices(const ingest::Motion& motion, std::size_t frame) const;

  private:
    ingest::SmplBody body_;
    mutable std::mutex one_at_a_time_;
    mutable kernels::Device device_;
    mutable kernels::Skinning skinning_;
};

}  // namespace actformer::reports
