// A recording of AMASS (Mahmood et al. 2019): an .npz of SMPL+H's or SMPL-X's rotations.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "ingest/formats/rotational/rotational_motion.hpp"

namespace actformer::ingest {

struct AmassFile {
    std::uint64_t frames = 0;
    std::size_t joints =
        0;  ///< whose rotations are kept: 22 of SMPL+H and SMPL-X, which have no joints for hands; 24 of SMPL
    std::vector<double> vectors;      ///< (frames, joints, 3) radians
    std::vector<double> translation;  ///< (frames, 3) metres, z up
    double fps = 0;
    bool smplx =
        false;  ///< of the package SMPL-X, whose frame rates often differ from those that BABEL's labels were made with

    /// Refers to this object.
    RotationVectors rotation_vectors() const;
};

/// Throws Error, without the file's name, where the file is damaged, or no recording in the layout of AMASS.
AmassFile read_amass_file(std::string_view bytes);

/// Files of AMASS that hold no motion, by their names: a subject's shape, the first stage of fitting.
bool holds_no_motion(std::string_view stem);

}  // namespace actformer::ingest
