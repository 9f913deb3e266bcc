// Of what a motion is generated: random numbers that hang together over frames.
#pragma once

#include <cstdint>

namespace actformer::model {

enum class PriorKind {
    gp,       ///< every channel a Gaussian process over the frames
    gaussian  ///< one vector, repeated over the frames
};

/// What turns normal numbers into Gaussian processes. The covariance is the same, the motions of a seed are others.
enum class PriorRoot {
    triangular,  ///< Cholesky's factor, of the covariance with 1e-6 on its diagonal
    symmetric    ///< the symmetric root without negative eigenvalues
};

struct PriorSettings {
    PriorKind kind = PriorKind::gp;
    std::uint32_t channels = 120;
    double length_scale = 100;  ///< frames, of the last channel; channel c has (c+1)/channels of it
    std::uint32_t streams = 1;  ///< draws a motion: 1, or one a person
    PriorRoot root = PriorRoot::triangular;

    bool operator==(const PriorSettings&) const = default;
};

}  // namespace actformer::model
