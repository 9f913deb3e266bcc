// Recordings made to fit a dataset: frames cut out, joints in another order, another axis up.
#pragma once

#include "ingest/dataset/topology.hpp"
#include "ingest/formats/skeletal/recording.hpp"
#include "ingest/formats/skeletal/skeleton.hpp"
#include "ingest/formats/skeletal/up.hpp"

namespace actformer::ingest {

/// The frames from `first` up to `last`, which is not among them. 0 <= first < last <= frames.
Recording cut(const Recording& recording, std::uint32_t first, std::uint32_t last);

/// Moves the root by `way`, in every frame.
void shift(Recording& recording, const std::array<double, 3>& way);

/// Turns the world so that `up` becomes y, by a pivot above the root, which `skeleton` then has too. Nothing changes for y.
void turn_up(Recording& recording, Skeleton& skeleton, Up up);

/// Puts the joints, and their channels with them, into an order in which those that `skeleton` keeps come as in `wanted`, whose names
/// are the same and hang together in the same way. Depth first, as `wanted` must be too.
void put_in_order(Recording& recording, Skeleton& skeleton, const Topology& wanted);

}  // namespace actformer::ingest
