// Sizes that the recogniser's kernels are built with; a tuner finds the best of a device.
#pragma once

#include <cstdint>
#include <string>

#include "kernels/device.hpp"

namespace actformer::kernels {

struct Tiles {
    std::uint32_t vec = 16;         ///< numbers in a vector: 1, 2, 4, 8 or 16
    std::uint32_t rows = 6;         ///< rows of the tile of sums that a work-item of the multiply holds
    std::uint32_t vectors = 4;      ///< vectors across that tile
    std::uint32_t item_tiles = 32;  ///< tiles a work-item does one after the other
    std::uint32_t group = 1;        ///< work-items in a group of the multiply, at most
    bool columns_first = false;     ///< neighbouring work-items share rows, not weights
    std::uint32_t filter_vec =
        16;  ///< numbers in a vector of the temporal convolution's transforms; divides a block
    std::uint32_t sequences = 8;  ///< sequences that go through the network together

    /// Columns of a tile: channels are padded to a multiple of this.
    std::uint32_t block() const { return vec * vectors; }

    bool operator==(const Tiles&) const = default;
};

/// What does well on devices of this kind without tuning.
Tiles default_tiles(const DeviceInfo& device);

/// "64 rows x 2 float16, 4 tiles an item, ...", for people and as part of keys.
std::string describe(const Tiles& tiles);

}  // namespace actformer::kernels
