// What is measured of motions, on disk.
//
// HDF5, float32: limb_acceleration, root_acceleration, root_speed, foot_sliding (n), distances (n, columns); those of no number are left out.
#pragma once

#include <filesystem>

#include "eval/metrics/motion_measures.hpp"

namespace actformer::eval {

/// Throws Error as write_whole() does.
void write_measures(const std::filesystem::path& path, const MotionMeasures& measures);

/// Throws Error as hdf5::Reader does, and where the arrays are not of the same motions.
MotionMeasures read_measures(const std::filesystem::path& path);

}  // namespace actformer::eval
