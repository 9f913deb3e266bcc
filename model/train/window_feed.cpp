#include "model/train/window_feed.hpp"

#include <limits>

#include "base/error.hpp"

namespace actformer::model {
namespace {

constexpr auto nothing = std::numeric_limits<std::uint64_t>::max();

Windows windows_of(kernels::Batch& batch) {
    const auto view = batch.map();
    return {batch.filled(), view.values.data(), view.labels.data()};
}

}  // namespace

RandomFeed::RandomFeed(const kernels::ClipStore& clips, const kernels::SamplerOptions& options,
                       std::uint32_t batch, std::uint32_t frames)
    : sampler_(clips, options),
      slots_{{clips, batch, frames}, {clips, batch, frames}},
      drawn_{nothing, nothing} {}

Windows RandomFeed::batch(std::uint64_t index) {
    const auto draw = [&](std::uint64_t i) {
        auto& slot = slots_[i % 2];
        if (drawn_[i % 2] == i) return;
        slot.unmap();
        sampler_.draw(i, slot);
        drawn_[i % 2] = i;
    };
    draw(index);
    draw(index + 1);
    return windows_of(slots_[index % 2]);
}

void for_each_window(const kernels::ClipStore& clips, std::uint32_t batch, std::uint32_t frames,
                     const std::function<void(const Windows&)>& use) {
    const kernels::WindowCutter cutter(clips, kernels::consecutive_windows(clips.table().frames, frames));
    kernels::Batch slots[2]{{clips, batch, frames}, {clips, batch, frames}};
    const auto cut = [&](std::size_t i) {
        if (i * batch >= cutter.windows()) return;
        slots[i % 2].unmap();
        cutter.cut(i * batch, slots[i % 2]);
    };
    cut(0);
    for (std::size_t i = 0; i * batch < cutter.windows(); ++i) {
        cut(i + 1);
        use(windows_of(slots[i % 2]));
    }
}

}  // namespace actformer::model
