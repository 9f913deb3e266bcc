// A recording of AMASS (Mahmood et al. 2019): an .npz of SMPL+H's or SMPL-X's rotations.
#pragma once

#include <functional>
#include <string_view>

#include "ingest/formats/rotational/rotational_motion.hpp"

namespace actformer::ingest {

struct AmassRecording {
    RotationVectors
        motion;  ///< z up; of 22 joints for SMPL+H and SMPL-X, which have none for whole hands, of 24 for SMPL
    double fps = 0;
    bool smplx =
        false;  ///< of the package SMPL-X, whose frame rates often differ from those that BABEL's labels were made with
};

/// Calls `use` with what an .npz holds; it lives until `use` returns. Throws Error, without the file's name, where the file is damaged or
/// no recording in the layout of AMASS, and what `use` throws.
void read_amass_file(std::string_view bytes, const std::function<void(const AmassRecording&)>& use);

/// Files of AMASS that hold no motion, by their names: a subject's shape, the first stage of fitting.
bool holds_no_motion(std::string_view stem);

}  // namespace actformer::ingest
