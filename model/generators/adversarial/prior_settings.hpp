// Of what a motion is generated: random numbers that hang together over frames.
#pragma once

#include <cstdint>

namespace actformer::model {

enum class PriorKind {
    gp,       ///< every channel a Gaussian process over the frames
    gaussian  ///< one vector, repeated over the frames
};

struct PriorSettings {
    PriorKind kind = PriorKind::gp;
    std::uint32_t channels = 120;
    double length_scale = 100;  ///< frames, of the last channel; channel c has (c+1)/channels of it
    std::uint32_t streams = 1;  ///< draws a motion: 1, or one a person

    bool operator==(const PriorSettings&) const = default;
};

}  // namespace actformer::model
