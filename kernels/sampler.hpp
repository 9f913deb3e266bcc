// Batches of windows for training and for evaluation, made on the device from clips that lie there; or by the processor itself.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/buffer.hpp"
#include "kernels/clip_table.hpp"
#include "kernels/host_buffer.hpp"
#include "kernels/plain_sampler.hpp"

namespace actformer::kernels {

/// Clips on a device, or in memory where there is none: every frame, and which clip has which label.
class ClipStore {
  public:
    /// In memory: its windows are drawn by the processor itself. Throws Error as below.
    explicit ClipStore(ClipTable table);

    /// Makes room. Throws Error for a table without clips, a clip without frames, or frames that do not fit on the device.
    ClipStore(Device& device, ClipTable table);

    /// The frames of one clip: values (frames, P, nodes, numbers).
    void load(std::size_t clip, std::span<const float> values);

    const ClipTable& table() const { return table_; }
    bool on_device() const { return device_ != nullptr; }
    Device& device() const { return *device_; }  ///< where on_device()
    std::span<const float> in_memory(
        std::size_t clip) const;  ///< (frames, P, nodes, numbers) where not on_device()
    const Buffer<float>& motion() const { return motion_; }
    const Buffer<std::uint32_t>& clips() const { return clips_; }

  private:
    std::size_t place();  ///< fills first_; how many frames there are

    Device* device_ = nullptr;
    ClipTable table_;
    std::vector<std::uint64_t> first_;  ///< frame of each clip
    std::vector<float> memory_;         ///< of all clips, where there is no device
    Buffer<float> motion_;
    Buffer<std::uint32_t> clips_;  ///< (clips, 4): first frame, frames, label, 0
};

/// A batch in memory that host and device share. Make two and fill one while the other is read.
class Batch {
  public:
    Batch(const ClipStore& clips, std::uint32_t samples, std::uint32_t window);

    std::uint32_t samples() const { return samples_; }
    std::uint32_t window() const { return window_; }

    /// How many of the samples were filled last.
    std::uint32_t filled() const { return filled_; }

    struct View {
        std::span<const float> values;          ///< (filled, P*numbers, window, nodes)
        std::span<const std::uint32_t> labels;  ///< (filled)
        std::span<const std::uint32_t> picks;   ///< (filled, 2): the clip and its first frame
    };

    /// Waits until the batch is made. The spans are good until it is filled anew, unmapped or gone.
    View map();
    void unmap();

    /// The values (samples, P*numbers, window, nodes) for kernels that read them on the device, while not mapped.
    const cl::Buffer& values() const { return values_.memory(); }

  private:
    friend class Sampler;
    friend class WindowCutter;
    void begin(std::uint32_t filled, const ClipStore& clips);
    void show(std::uint32_t sample, const DrawnWindow& chosen, Padding padding,
              const ClipStore& clips);  ///< in memory

    std::uint32_t samples_ = 0, window_ = 0, filled_ = 0;
    std::size_t sample_values_ = 0;
    HostBuffer<float> values_;
    HostBuffer<std::uint32_t> labels_, picks_;
};

/// Random batches: a class, a clip of it, a window (a crop of a longer clip; a shorter one is padded), the order
/// of its persons. Sample j of batch i under seed s is the same on every device and for every batch size: only integers
/// decide. Classes without clips are never drawn.
class Sampler {
  public:
    /// `clips` must outlive the sampler.
    Sampler(const ClipStore& clips, const SamplerOptions& options);

    /// Starts to fill `into` with batch `index` and returns at once; into.map() waits for it. In memory it is full then.
    void draw(std::uint64_t index, Batch& into) const;

  private:
    const ClipStore* clips_;
    SamplerOptions options_;
    ClassTable classes_;
    Buffer<std::uint32_t> by_class_, class_first_;  ///< of classes_, on the device
    Buffer<std::uint64_t> class_edge_;
};

/// The weight of a class of `clips` clips: the square root in steps of 2^-16, or the number itself in the same steps.
std::uint64_t class_weight(std::uint64_t clips, ClassSampling how);

struct Window {
    std::uint32_t clip = 0, first = 0;
    bool operator==(const Window&) const = default;
};

/// Consecutive windows of `window` frames of every clip in turn. What is left of a clip at its end is dropped; a clip
/// shorter than a window gives one that runs back and forth.
std::vector<Window> consecutive_windows(std::span<const std::uint32_t> frames, std::uint32_t window);

/// Windows in a given order, each as it is in the clip: for evaluation.
class WindowCutter {
  public:
    /// `clips` must outlive the cutter.
    WindowCutter(const ClipStore& clips, const std::vector<Window>& windows);

    std::size_t windows() const { return windows_.size(); }

    /// Starts to fill `into` with the windows from number `first` on, as many as it holds and there are.
    void cut(std::size_t first, Batch& into) const;

  private:
    const ClipStore* clips_;
    std::vector<Window> windows_;
    Buffer<std::uint32_t> on_device_;  ///< (windows, 2)
};

}  // namespace actformer::kernels
