// Tile sizes found by measuring, kept for each device in a file of the user's cache.
#pragma once

#include <filesystem>
#include <functional>

#include "eval/stgcn/weights.hpp"
#include "kernels/tiles.hpp"

namespace actformer::eval {

/// $XDG_CACHE_HOME/actformer/tiles.json, or the same under ~/.cache.
std::filesystem::path tiles_file();

/// The tiles found for this device and driver, else default_tiles(). Throws Error where the file is damaged.
kernels::Tiles load_tiles(const kernels::DeviceInfo& device);

/// Keeps `tiles` for this device and driver. Throws Error where the file cannot be written.
void save_tiles(const kernels::DeviceInfo& device, const kernels::Tiles& tiles);

/// Measures the recogniser with one choice after another: first the shapes of a tile, then how much a work-item does, then
/// how many sequences go together. `tell` hears of each choice and its sequences a second.
kernels::Tiles tune(kernels::Device& device, const StgcnWeights& weights, std::uint32_t sequences,
                    std::uint32_t frames, const std::function<void(const kernels::Tiles&, double)>& tell);

/// Sequences a second, best of `repeats`.
double measure_rate(kernels::Device& device, const StgcnWeights& weights, const kernels::Tiles& tiles,
                    std::uint32_t sequences, std::uint32_t frames, int repeats);

}  // namespace actformer::eval
