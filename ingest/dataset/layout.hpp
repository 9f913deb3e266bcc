// The orders in which a motion's numbers lie: one place that turns one into another.
//
//   Motion and shards   (T, P, K, D)   frames first
//   networks            (P*D, T, K)    channels first, as samplers, generators and recognisers have them
//   files of motions    (P*D, K, T)    the public layout
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ingest/dataset/motion.hpp"

namespace actformer::ingest {

/// (channels, rows, columns) as (channels, columns, rows): between networks and files of motions, both ways.
std::vector<float> with_last_axes_swapped(std::span<const float> values, std::size_t channels,
                                          std::size_t rows, std::size_t columns);

/// A motion as networks have it, (P*D, T, K).
std::vector<float> channels_first(const Motion& motion);

/// Fills `motion.values` from what networks have; its sizes say how many.
void take_channels_first(std::span<const float> values, Motion& motion);

}  // namespace actformer::ingest
