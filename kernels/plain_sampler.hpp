// What cl/sampler.cl does, by the processor itself: for machines without OpenCL. The same choices, and the same numbers to the bit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/clip_table.hpp"

namespace actformer::kernels {

/// Clips by their class, and how likely each class is drawn.
struct ClassTable {
    std::vector<std::uint32_t> by_class,
        first{0};                     ///< (clips) by label; (classes that have any + 1) where each begins
    std::vector<std::uint64_t> edge;  ///< (classes that have any) running sum of their weights
};

ClassTable class_table(const ClipTable& table, ClassSampling how);

/// What a window shows: a clip from a frame on, its persons in an order of four bits each.
struct DrawnWindow {
    static constexpr std::uint64_t own_order = 0xFEDCBA9876543210;

    std::uint32_t clip = 0, first = 0;
    std::uint64_t order = own_order;
};

/// Sample `sample` of batch `index`, drawn as kernel `draw` does.
DrawnWindow drawn(const ClipTable& table, const ClassTable& classes, const SamplerOptions& options,
                  std::uint64_t index, std::uint32_t sample, std::uint32_t window);

/// The window (P*C, T, K) of `clip`, the values (frames, P, K, C) of the clip that `chosen` names; centred where the table says so.
void show(const ClipTable& table, std::span<const float> clip, const DrawnWindow& chosen, Padding padding,
          std::uint32_t window, std::span<float> to);

}  // namespace actformer::kernels
