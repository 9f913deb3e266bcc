// How tall the bodies of a dataset are.
#pragma once

#include <optional>

#include "ingest/dataset/dataset.hpp"

namespace actformer::ingest {

inline constexpr double tallest_body = 4;  ///< metres: what is taller is in another unit

struct BodyHeight {
    double metres = 0;
    char axis = 'y';  ///< along which bodies are tall: not y where another axis is up, or they lie
    int up = 0;       ///< 1: they point along the axis, -1: the other way; 0: names do not tell
};

/// From the first joint to the last along an axis: of a clip what a tenth of its frames exceed, of the dataset the median over some
/// clips spread over it. The axis is the one along which spine and head point from the root; where names do not tell them, y, unless
/// another is a quarter longer. Head and hands reach a little beyond their joints. Nothing where there is no clip.
std::optional<BodyHeight> body_height(const Dataset& dataset);

/// The same of one motion. Throws Error as check_fits does.
std::optional<BodyHeight> body_height(const Motion& motion, const BodyModel& body);

}  // namespace actformer::ingest
