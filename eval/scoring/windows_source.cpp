#include "eval/scoring/windows_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/error.hpp"
#include "ingest/dataset/view.hpp"

namespace actformer::eval {
namespace {

/// Room for as many windows as asked for, or as the device's memory holds.
kernels::Batch make_batch(const kernels::ClipStore& clips, std::size_t samples, std::uint32_t window) {
    while (true) {
        try {
            return {clips, static_cast<std::uint32_t>(samples), window};
        } catch (const OutOfMemory&) {
            if (samples == 1) throw;
            samples /= 2;
        }
    }
}

class WindowsSource final : public MotionSource {
  public:
    WindowsSource(kernels::Device& device, const WindowsOptions& options)
        : device_(&device), options_(options), dataset_(options.dataset) {
        info_ = describe(dataset_, options.joints);
        list_windows();
        info_.are_windows = true;
        info_.shortest = info_.longest = options_.window;
        info_.view = fmt::format("split {}, windows of {} frames", options_.split, options_.window);
    }

    const MotionsInfo& info() const override { return info_; }
    MotionBatch next() override;

  private:
    void list_windows();

    /// The split on the device.
    struct Loaded {
        Loaded(kernels::Device& device, const ingest::Dataset& dataset, const WindowsOptions& options,
               const std::vector<kernels::Window>& windows)
            : clips(ingest::load_view(device, dataset, options.split, options.joints).store),
              cutter(clips, windows),
              batch(make_batch(clips, std::min<std::size_t>(options.batch, windows.size()), options.window)) {
        }
        kernels::ClipStore clips;
        kernels::WindowCutter cutter;
        kernels::Batch batch;
    };

    kernels::Device* device_;
    WindowsOptions options_;
    ingest::Dataset dataset_;
    MotionsInfo info_;
    std::vector<kernels::Window> windows_;
    std::unique_ptr<Loaded> loaded_;
    std::size_t first_ = 0;  ///< of the windows that have not come yet
};

void WindowsSource::list_windows() {
    const auto clips = ingest::clips_in(dataset_, options_.split);
    std::vector<std::uint32_t> frames;
    for (const auto clip : clips) frames.push_back(dataset_.clips()[clip].frames);
    windows_ = kernels::consecutive_windows(frames, options_.window);
    for (const auto& window : windows_) {
        const auto& clip = dataset_.clips()[clips[window.clip]];
        info_.names.push_back(fmt::format("{}@{}", clip.name, window.first));
        info_.labels.push_back(clip.label);
    }
}

MotionBatch WindowsSource::next() {
    if (first_ == windows_.size()) return {};
    if (!loaded_) loaded_ = std::make_unique<Loaded>(*device_, dataset_, options_, windows_);
    loaded_->cutter.cut(first_, loaded_->batch);
    MotionBatch batch;
    batch.rows.resize(loaded_->batch.filled());
    std::iota(batch.rows.begin(), batch.rows.end(), std::uint64_t{first_});
    batch.frames = options_.window;
    batch.on_device = &loaded_->batch.values();
    first_ += batch.rows.size();
    return batch;
}

}  // namespace

std::unique_ptr<MotionSource> open_windows(kernels::Device& device, const WindowsOptions& options) {
    return std::make_unique<WindowsSource>(device, options);
}

MotionsInfo describe(const ingest::Dataset& dataset, ingest::Joints joints) {
    const auto& header = dataset.header();
    const auto representation = ingest::representation_of(dataset, joints);
    const auto& topology = ingest::topology_of(dataset, joints);
    MotionsInfo out;
    out.source = dataset.folder().string();
    out.representation = representation;
    out.classes = header.classes;
    out.persons = header.persons;
    out.channels = header.persons * representation.numbers();
    out.joints = representation.nodes(topology);
    out.parents = representation.node_parents(topology);
    out.fingerprint = dataset.fingerprint();
    return out;
}

std::string clip_of(const std::string& window) {
    const auto at = window.rfind('@');
    const bool numbered = at != std::string::npos && at + 1 < window.size() &&
                          window.find_first_not_of("0123456789", at + 1) == std::string::npos;
    return numbered ? window.substr(0, at) : window;
}

}  // namespace actformer::eval
