// Typed arrays in device memory, and launching a kernel over them.
#pragma once

#include <span>
#include <vector>

#include "kernels/device.hpp"

namespace actformer::kernels {

/// `count` values of T on a device. Copies share the memory, as OpenCL's handles do.
template <typename T>
class Buffer {
  public:
    Buffer() = default;

    Buffer(Device& device, std::size_t count) : device_(&device), count_(count) {
        try {
            // OpenCL has no empty buffers; one spare value stands for none.
            memory_ = cl::Buffer(device.context(), CL_MEM_READ_WRITE, std::max<std::size_t>(count, 1) * sizeof(T));
        } catch (const cl::Error& e) {
            raise(device.info(), fmt::format("allocating {} bytes", count * sizeof(T)), e);
        }
    }

    Buffer(Device& device, std::span<const T> values) : Buffer(device, values.size()) { upload(values); }
    Buffer(Device& device, const std::vector<T>& values) : Buffer(device, std::span<const T>(values)) {}

    std::size_t size() const { return count_; }
    const cl::Buffer& memory() const { return memory_; }

    /// Copies as many values as `values` holds to the front; returns once they may change again.
    void upload(std::span<const T> values) {
        if (values.empty()) return;
        try {
            device_->queue().enqueueWriteBuffer(memory_, CL_TRUE, 0, values.size_bytes(), values.data());
        } catch (const cl::Error& e) {
            raise(device_->info(), "copying to the device", e);
        }
    }

    /// Waits for all that was launched before and fills `values` from the front.
    void download(std::span<T> values) const {
        if (values.empty()) return;
        try {
            device_->queue().enqueueReadBuffer(memory_, CL_TRUE, 0, values.size_bytes(), values.data());
        } catch (const cl::Error& e) {
            raise(device_->info(), "copying from the device", e);
        }
    }

    std::vector<T> download() const {
        std::vector<T> values(count_);
        download(values);
        return values;
    }

  private:
    Device* device_ = nullptr;
    std::size_t count_ = 0;
    cl::Buffer memory_;
};

namespace detail {
template <typename T>
const cl::Buffer& argument(const Buffer<T>& b) {
    return b.memory();
}
template <typename T>
T argument(T value) {
    static_assert(std::is_arithmetic_v<T> && sizeof(T) == 4, "kernels take 32-bit numbers and buffers");
    return value;
}
}  // namespace detail

/// Enqueues `kernel` over `range` work-items with the given arguments (buffers, 32-bit numbers). The driver picks the
/// work-group size. An empty range launches nothing.
template <typename... Args>
void launch(Device& device, cl::Kernel kernel, const cl::NDRange& range, const Args&... args) {
    for (std::size_t d = 0; d < range.dimensions(); ++d)
        if (range.get()[d] == 0) return;
    try {
        cl_uint i = 0;
        (kernel.setArg(i++, detail::argument(args)), ...);
        device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, range, cl::NullRange);
    } catch (const cl::Error& e) {
        raise(device.info(), fmt::format("running kernel {}", kernel.getInfo<CL_KERNEL_FUNCTION_NAME>()), e);
    }
}

}  // namespace actformer::kernels
