#include "ingest/formats/skeletal/recording.hpp"

#include <cmath>

namespace actformer::ingest {

double Recording::fps() const {
    const double exact = 1 / frame_time, whole = std::round(exact);
    return std::abs(exact - whole) < 0.0015 * whole ? whole : exact;
}

}  // namespace actformer::ingest
