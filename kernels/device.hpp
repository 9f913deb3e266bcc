// OpenCL devices: what there is, which one to use, and running kernels on it.
#pragma once

#include <CL/opencl.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace actformer::kernels {

class MemoryPool;
class ProgramCache;

/// What matters of a device when choosing one.
struct DeviceInfo {
    std::size_t index = 0;  ///< its number for --device
    std::string name, platform, version, driver;
    std::string type;  ///< "GPU", "CPU" or "accelerator"
    std::uint32_t compute_units = 0;
    std::uint32_t clock_mhz = 0;
    std::uint64_t memory = 0;          ///< bytes
    std::uint64_t max_allocation = 0;  ///< bytes of the largest single buffer
    bool shares_memory = false;        ///< with the host
    std::uint32_t vector_width = 0;    ///< floats in a register
};

/// Every OpenCL device, in the order that --device numbers them. Empty without an OpenCL driver.
std::vector<DeviceInfo> list_devices();

/// Index into `devices` of the one that `wish` means: a number, "gpu" or "cpu", or part of a name in any case.
/// An empty wish means ACTFORMER_DEVICE where set, else the GPU with most memory of its own, else one that shares the machine's, else the
/// first device.
/// Throws Error where nothing fits, naming what there is.
std::size_t choose_device(const std::vector<DeviceInfo>& devices, std::string_view wish);

/// One device with its context and its in-order queue. Calls may come from one thread at a time.
class Device {
  public:
    explicit Device(std::string_view wish = {});
    ~Device();
    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;

    const DeviceInfo& info() const { return info_; }
    const cl::Device& handle() const { return device_; }
    const cl::Context& context() const { return context_; }
    cl::CommandQueue& queue() { return queue_; }
    MemoryPool& memory() { return *memory_; }

    /// Kernel `name` of kernels/cl/FILE.cl, built once per (source, options, device).
    /// Throws Error with the compiler's log where the build fails.
    cl::Kernel kernel(std::string_view file, const std::string& name, const std::string& options = {});

    /// The same for a kernel of vectors of `vec` floats, which vectors.cl defines.
    cl::Kernel vector_kernel(std::string_view file, const std::string& name, std::uint32_t vec,
                             const std::string& options = {});

    /// The same from any source text; `label` names it in errors.
    cl::Kernel kernel_from(std::string_view text, std::string_view label, const std::string& name,
                           const std::string& options = {});

  private:
    DeviceInfo info_;
    cl::Device device_;
    cl::Context context_;
    cl::CommandQueue queue_;
    std::shared_ptr<MemoryPool> memory_;
    std::unique_ptr<ProgramCache> programs_;
};

/// Throws an Error that says in words what `error` means while doing `what` on `device`.
[[noreturn]] void raise(const DeviceInfo& device, std::string_view what, const cl::Error& error);

}  // namespace actformer::kernels
