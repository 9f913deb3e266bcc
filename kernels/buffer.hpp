// Typed arrays in device memory, and launching a kernel over them.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "kernels/device.hpp"
#include "kernels/memory_pool.hpp"

namespace actformer::kernels {

/// Values of a buffer as host memory for as long as it lives, in place where the device shares memory. The device must not
/// use them meanwhile. May end in any thread.
template <typename T>
class Mapping {
  public:
    Mapping() = default;
    Mapping(Device& device, std::shared_ptr<const cl::Buffer> memory, std::size_t count, cl_map_flags how)
        : queue_(device.queue()), memory_(std::move(memory)) {
        if (count == 0) return;
        try {
            values_ = {static_cast<T*>(queue_.enqueueMapBuffer(*memory_, CL_TRUE, how, 0, count * sizeof(T))),
                       count};
        } catch (const cl::Error& e) {
            raise(device.info(), "mapping device memory", e);
        }
    }
    ~Mapping() {
        // Fails only where the device is lost, which the next call reports.
        if (!values_.empty())
            clEnqueueUnmapMemObject(queue_(), (*memory_)(), values_.data(), 0, nullptr, nullptr);
    }
    Mapping(Mapping&& other) noexcept { swap(other); }
    Mapping& operator=(Mapping&& other) noexcept {
        swap(other);
        return *this;
    }

    std::span<T> values() const { return values_; }

  private:
    void swap(Mapping& other) noexcept {
        std::swap(queue_, other.queue_);
        std::swap(memory_, other.memory_);
        std::swap(values_, other.values_);
    }

    cl::CommandQueue queue_;
    std::shared_ptr<const cl::Buffer> memory_;
    std::span<T> values_;
};

/// `count` values of T on a device. Copies share the memory, as OpenCL's handles do.
template <typename T>
class Buffer {
  public:
    Buffer() = default;

    /// `spare` values behind the others may be read by kernels, which make no use of them.
    Buffer(Device& device, std::size_t count, std::size_t spare = 0) : device_(&device), count_(count) {
        try {
            // OpenCL has no empty buffers: an empty one has a spare value.
            memory_ = device.memory().take(std::max<std::size_t>(count + spare, 1) * sizeof(T));
        } catch (const cl::Error& e) {
            raise(device.info(), fmt::format("allocating {} bytes", count * sizeof(T)), e);
        }
    }

    Buffer(Device& device, std::span<const T> values) : Buffer(device, values.size()) { upload(values); }
    Buffer(Device& device, const std::vector<T>& values) : Buffer(device, std::span<const T>(values)) {}

    std::size_t size() const { return count_; }
    const cl::Buffer& memory() const { return *memory_; }  ///< of a buffer that has a device

    /// Copies as many values as `values` holds to the front; returns once they may change again.
    void upload(std::span<const T> values) {
        if (values.empty()) return;
        try {
            device_->queue().enqueueWriteBuffer(*memory_, CL_TRUE, 0, values.size_bytes(), values.data());
        } catch (const cl::Error& e) {
            raise(device_->info(), "copying to the device", e);
        }
    }

    /// Waits for all that was launched before and fills `values` from the front.
    void download(std::span<T> values) const {
        if (values.empty()) return;
        try {
            device_->queue().enqueueReadBuffer(*memory_, CL_TRUE, 0, values.size_bytes(), values.data());
        } catch (const cl::Error& e) {
            raise(device_->info(), "copying from the device", e);
        }
    }

    std::vector<T> download() const {
        const auto all = map();
        return {all.values().begin(), all.values().end()};
    }

    /// All values, to be read, once all that was launched before is done.
    Mapping<T> map() const {
        return count_ == 0 ? Mapping<T>() : Mapping<T>(*device_, memory_, count_, CL_MAP_READ);
    }

    /// Calls `fill` with a span over all values, to be written; where the device shares memory, in place. What `fill` leaves
    /// out is undefined.
    template <typename Fill>
    void write_with(Fill fill) {
        if (count_ > 0) fill(Mapping<T>(*device_, memory_, count_, CL_MAP_WRITE_INVALIDATE_REGION).values());
    }

  private:
    Device* device_ = nullptr;
    std::size_t count_ = 0;
    std::shared_ptr<const cl::Buffer> memory_;
};

namespace detail {
template <typename T>
const cl::Buffer& argument(const Buffer<T>& b) {
    return b.memory();
}
inline const cl::Buffer& argument(const cl::Buffer& b) {
    return b;
}
template <typename T>
T argument(T value) {
    static_assert(std::is_arithmetic_v<T> && sizeof(T) == 4, "kernels take 32-bit numbers and buffers");
    return value;
}
}  // namespace detail

/// Work-items a group along each dimension, found from what the device and the kernel allow. Groups depend on the range
/// only through its order of magnitude: drivers that compile a kernel anew for every group size (PoCL) do so seldom.
/// `wanted` at most: enough to fill a GPU's wavefronts, few enough for many groups on a CPU's cores.
std::array<std::size_t, 2> group_size(const Device& device, const cl::Kernel& kernel,
                                      std::array<std::size_t, 2> range, std::size_t wanted = 128);

/// Enqueues `kernel` over at least `range` (x, y) work-items, rounded up to whole groups: the kernel itself leaves out those
/// beyond. Arguments are buffers and 32-bit numbers. An empty range launches nothing.
template <typename... Args>
void launch(Device& device, cl::Kernel kernel, std::array<std::size_t, 2> range, const Args&... args) {
    if (range[0] == 0 || range[1] == 0) return;
    try {
        cl_uint i = 0;
        (kernel.setArg(i++, detail::argument(args)), ...);
        const auto group = group_size(device, kernel, range);
        const cl::NDRange whole((range[0] + group[0] - 1) / group[0] * group[0],
                                (range[1] + group[1] - 1) / group[1] * group[1]);
        device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, whole, cl::NDRange(group[0], group[1]));
    } catch (const cl::Error& e) {
        raise(device.info(), fmt::format("running kernel {}", kernel.getInfo<CL_KERNEL_FUNCTION_NAME>()), e);
    }
}

/// The same over (x, y, z) work-items in groups of at most `items`, for kernels that are particular about their groups.
template <typename... Args>
void launch(Device& device, cl::Kernel kernel, std::array<std::size_t, 3> range, std::size_t items,
            const Args&... args) {
    if (range[0] == 0 || range[1] == 0 || range[2] == 0) return;
    try {
        cl_uint i = 0;
        (kernel.setArg(i++, detail::argument(args)), ...);
        const auto group = group_size(device, kernel, {range[0], range[1]}, items);
        const cl::NDRange whole((range[0] + group[0] - 1) / group[0] * group[0],
                                (range[1] + group[1] - 1) / group[1] * group[1], range[2]);
        device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, whole, cl::NDRange(group[0], group[1], 1));
    } catch (const cl::Error& e) {
        raise(device.info(), fmt::format("running kernel {}", kernel.getInfo<CL_KERNEL_FUNCTION_NAME>()), e);
    }
}

}  // namespace actformer::kernels
