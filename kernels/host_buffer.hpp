// Device memory that the host reads in place, or memory of the host where there is no device.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "kernels/buffer.hpp"

namespace actformer::kernels {

/// `count` values of T where both sides reach them: one and the same memory on a device that shares it with the host,
/// page-locked host memory on most others. Without a device it is the host's alone.
template <typename T>
class HostBuffer {
  public:
    HostBuffer() = default;
    HostBuffer(Device* device, std::size_t count) : device_(device), count_(count) {
        if (!device) {
            own_.resize(count);
            return;
        }
        try {
            memory_ = cl::Buffer(device->context(), CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR,
                                 std::max<std::size_t>(count, 1) * sizeof(T));
        } catch (const cl::Error& e) {
            raise(device->info(), fmt::format("allocating {} bytes", count * sizeof(T)), e);
        }
    }
    ~HostBuffer() {
        try {
            unmap();
        } catch (const Error&) {  // the device is lost: nothing is left to release
        }
    }
    HostBuffer(HostBuffer&& other) noexcept { swap(other); }
    HostBuffer& operator=(HostBuffer&& other) noexcept {
        swap(other);
        return *this;
    }

    std::size_t size() const { return count_; }
    const cl::Buffer& memory() const { return memory_; }  ///< of a buffer that has a device

    std::span<T> in_memory() { return own_; }  ///< of a buffer without a device, to be filled

    /// Asks for the values as they are once everything launched before is done; returns at once.
    void begin_map() {
        if (mapped_ || !device_) return;
        try {
            mapped_ = static_cast<T*>(device_->queue().enqueueMapBuffer(
                memory_, CL_FALSE, CL_MAP_READ, 0, std::max<std::size_t>(count_, 1) * sizeof(T), nullptr,
                &ready_));
            device_->queue().flush();
        } catch (const cl::Error& e) {
            raise(device_->info(), "mapping a buffer", e);
        }
    }

    /// Waits for the values. The span is good until unmap() or the end of this buffer; the device must not use it before.
    std::span<const T> map() {
        if (!device_) return own_;
        begin_map();
        try {
            ready_.wait();
        } catch (const cl::Error& e) {
            raise(device_->info(), "mapping a buffer", e);
        }
        return {mapped_, count_};
    }

    /// Hands the values back to the device.
    void unmap() {
        if (!mapped_) return;
        try {
            device_->queue().enqueueUnmapMemObject(memory_, std::exchange(mapped_, nullptr));
        } catch (const cl::Error& e) {
            raise(device_->info(), "unmapping a buffer", e);
        }
    }

  private:
    void swap(HostBuffer& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(count_, other.count_);
        std::swap(own_, other.own_);
        std::swap(memory_, other.memory_);
        std::swap(mapped_, other.mapped_);
        std::swap(ready_, other.ready_);
    }

    Device* device_ = nullptr;
    std::size_t count_ = 0;
    std::vector<T> own_;
    cl::Buffer memory_;
    T* mapped_ = nullptr;
    cl::Event ready_;
};

}  // namespace actformer::kernels
