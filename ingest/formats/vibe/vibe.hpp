// Persons whom VIBE (Kocabas et al. 2020) tracked in a video: what NTU-13 and UESTC are made of.
//
// Its camera looks along z, x points right and y down. Joints are 49: OpenPose's 25, then 24 of other data sets.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/numpy/rows.hpp"
#include "ingest/dataset/topology.hpp"

namespace actformer::ingest::vibe {

inline constexpr std::size_t joints = 49;
inline constexpr std::size_t mid_hip = 8;

/// (frames, 49, 3) metres about the body's root, which the file calls `name`. Throws Error where it has another shape.
NumpyRows joint_rows(const NumpyArray& array, const std::string& name);

/// The 18 joints of Action2Motion (Guo et al. 2020) out of them, mid-hip first.
const Topology& action2motion18();
inline constexpr std::array<std::size_t, 18> of_action2motion18{8, 1,  2,  3,  4,  5,  6,  7,  0,
                                                                9, 10, 11, 12, 13, 14, 21, 24, 38};

/// (frames, 18, 3) of joint_rows.
std::vector<double> action2motion18_of(const NumpyRows& joints);

}  // namespace actformer::ingest::vibe
