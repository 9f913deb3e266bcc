// One video of UESTC: what its name says, and how its body is turned and moved.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/numpy/rows.hpp"
#include "ingest/dataset/quaternion.hpp"

namespace actformer::ingest::uestc {

/// aACTION_dVIEW_pSUBJECT_cSIDE_color.avi
struct VideoName {
    std::uint32_t action = 0;  ///< from 0
    int view = 0;              ///< 0 to 7: eighths of a turn; 8: the camera goes round
    int subject = 0;           ///< from 1
    int side = 1;              ///< 1: the camera in front

    /// In the camera's frame, what makes the body face the camera in front; none for the camera that goes round, whose place is not
    /// told.
    std::optional<Quaternion> to_front() const;
};

/// Nothing where a name is not spelt so.
std::optional<VideoName> parse_video_name(std::string_view name);

/// A subject whose videos the published split trains on.
bool trains(int subject);
inline constexpr int subjects = 118;

/// (frames, 3) metres from the camera: across and down as VIBE has them, and away from it so that the body has the size in the picture,
/// 540 pixels wide at a focal length of 500, that VIBE saw (Petrovich et al. 2021, their code). `cameras` (frames, 4) is VIBE's
/// orig_cam, sx sy tx ty; `joints` (frames, 49, 3).
std::vector<double> trajectory(const NumpyRows& cameras, const NumpyRows& joints, std::uint64_t frames);

}  // namespace actformer::ingest::uestc
