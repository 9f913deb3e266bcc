// How much work the ST-GCN is.
#pragma once

#include "eval/stgcn/network.hpp"

namespace actformer::eval {

/// Multiplications and additions that the network's definition asks for a sequence (direct convolutions, the graph
/// multiplied as a dense matrix counts nothing), in floating-point operations.
double direct_operations(const StgcnShape& shape, std::uint32_t frames);

/// Those that the multiplies here do: Winograd's minimal filtering and empty neighbourhoods taken into account.
double multiplied_operations(const StgcnShape& shape, std::uint32_t frames);

}  // namespace actformer::eval
