#include "kernels/tiles.hpp"

namespace actformer::kernels {

Tiles default_tiles(const DeviceInfo& device) {
    Tiles tiles;
    if (device.type == "CPU") {
        if (device.vector_width >= 16) return tiles;
        tiles.vec = tiles.filter_vec = 8;  // for AVX2's 16 registers of 8: 12 hold sums
        tiles.rows = 6;
        tiles.vectors = 2;
        return tiles;
    }
    tiles.vec = 4;
    tiles.filter_vec = 1;
    tiles.rows = 8;
    tiles.vectors = 1;
    tiles.item_tiles = 1;
    tiles.group = 64;
    tiles.columns_first = true;
    tiles.sequences = 64;
    return tiles;
}

std::string describe(const Tiles& tiles) {
    return fmt::format(
        "{} rows x {} float{}, {} tiles an item, groups of {}{}, filters of float{}, {} sequences at once",
        tiles.rows, tiles.vectors, tiles.vec, tiles.item_tiles, tiles.group,
        tiles.columns_first ? " along columns" : "", tiles.filter_vec, tiles.sequences);
}

}  // namespace actformer::kernels
