// How the body of a recording stands: how tall, which way up, and whether its first frame belongs to the motion.
#pragma once

#include <optional>

#include "ingest/formats/skeletal/matrix.hpp"
#include "ingest/formats/skeletal/recording.hpp"

namespace actformer::ingest {

/// All lengths in the file's units.
struct Stance {
    Vector3 extent{};  ///< of the body along x, y, z: what a tenth of the frames looked at exceed
    double size = 0;   ///< median diagonal of the body, whichever way it lies

    /// Mean of upright_direction, of length 1 in every frame: shorter where the body turns over. Nothing where the joints' names do
    /// not tell what they are.
    std::optional<Vector3> upright;
};

/// Looks at a few frames from `first` on, of the joints from `root` on: what stands above it is no part of the body.
Stance stance_of(const Recording& recording, std::size_t root, std::uint32_t first = 0);

/// True where the joints move at least a tenth of the body's size from the first frame to the second, on average, and four times as
/// far as in any of the steps that follow: the first frame is then a reference pose, or at another place.
bool begins_with_jump(const Recording& recording, std::size_t root);

/// True where no number changes over the frames.
bool stands_still(const Recording& recording);

/// The unit, in metres, in which a body of `height` units is nearest to 1.7 m: metre, foot, 1/0.45 inch (CMU's), inch, centimetre or
/// millimetre; where none brings it within a factor of 3, what makes it 1.7 m, to two digits.
double fitting_scale(double height);

}  // namespace actformer::ingest
