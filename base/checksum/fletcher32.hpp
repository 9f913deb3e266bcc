// The checksum that HDF5 puts behind a chunk, an order of magnitude faster than the library makes it.
#pragma once

#include <cstdint>
#include <span>

namespace actformer {

/// Fletcher's sums of 16-bit words modulo 65535, as HDF5's filter H5Z_FILTER_FLETCHER32 takes them: the high byte of a word first.
std::uint32_t fletcher32(std::span<const float> values);

}  // namespace actformer
