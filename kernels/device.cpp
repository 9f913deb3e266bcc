#include "kernels/device.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdlib>
#include <tuple>

#include "base/text/lower_case.hpp"
#include "base/threads/parallel.hpp"
#include "kernels/buffer.hpp"
#include "kernels/memory_pool.hpp"
#include "kernels/pocl_cache.hpp"
#include "kernels/program_cache.hpp"
#include "kernels/sources.hpp"

namespace actformer::kernels {
namespace {

/// PoCL aborts where it is refused the thread that it starts for every core, or a process or two while it links a kernel.
std::vector<cl::Device> raw_devices() {
    expect_threads(thread_count(0) + 2);
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error&) {
        return {};  // the loader reports "no platform" as an error
    }
    std::vector<cl::Device> all;
    for (const auto& platform : platforms) {
        std::vector<cl::Device> found;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
        } catch (const cl::Error&) {
            continue;  // a platform without devices
        }
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

DeviceInfo describe(const cl::Device& device, std::size_t index) {
    const auto type = device.getInfo<CL_DEVICE_TYPE>();
    DeviceInfo info;
    info.index = index;
    info.name = device.getInfo<CL_DEVICE_NAME>();
    info.platform = cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>();
    info.version = device.getInfo<CL_DEVICE_VERSION>();
    info.driver = device.getInfo<CL_DRIVER_VERSION>();
    info.type = (type & CL_DEVICE_TYPE_GPU) ? "GPU" : (type & CL_DEVICE_TYPE_CPU) ? "CPU" : "accelerator";
    info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    info.clock_mhz = device.getInfo<CL_DEVICE_MAX_CLOCK_FREQUENCY>();
    info.memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.max_allocation = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    info.shares_memory = device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() != 0;
    info.vector_width = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
    return info;
}

std::vector<DeviceInfo> described(const std::vector<cl::Device>& devices) {
    std::vector<DeviceInfo> out;
    out.reserve(devices.size());
    for (const auto& device : devices) out.push_back(describe(device, out.size()));
    return out;
}

std::string names_of(const std::vector<DeviceInfo>& devices) {
    std::string out;
    for (const auto& d : devices) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", d.index, d.name);
    return out;
}

/// A GPU with memory of its own before one that shares the machine's, however much that is.
std::size_t default_device(const std::vector<DeviceInfo>& devices) {
    const auto rank = [](const DeviceInfo& d) {
        const bool gpu = d.type == "GPU";
        return std::tuple(gpu, gpu && !d.shares_memory, gpu ? d.memory : 0);
    };
    return std::ranges::max_element(devices, {}, rank) - devices.begin();
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
    return described(raw_devices());
}

std::size_t choose_device(const std::vector<DeviceInfo>& devices, std::string_view wish) {
    if (devices.empty()) {
        if (const auto cache = unwritable_pocl_cache(); !cache.empty())
            throw Error(
                "no OpenCL device: PoCL cannot write its cache folder {}; "
                "let POCL_CACHE_DIR name a folder that can be written",
                cache.string());
        throw Error(
            "no OpenCL device: install a driver (on Debian without a GPU: apt install pocl-opencl-icd); "
            "where there "
            "is one, limits on memory and open files keep it out (ulimit -v, ulimit -n)");
    }
    const char* from = "";
    if (wish.empty()) {
        if (const char* set = std::getenv("ACTFORMER_DEVICE"); set && *set) {
            wish = set;
            from = "ACTFORMER_DEVICE: ";
        }
    }
    if (wish.empty()) return default_device(devices);

    std::size_t number = 0;
    const auto [end, error] = std::from_chars(wish.data(), wish.data() + wish.size(), number);
    if (error == std::errc() && end == wish.data() + wish.size()) {
        if (number < devices.size()) return number;
    } else {
        const auto text = lower_case(wish);
        for (const auto& d : devices)
            if (lower_case(d.type) == text) return d.index;
        for (const auto& d : devices)
            if (lower_case(d.name).find(text) != std::string::npos) return d.index;
    }
    throw Error("{}there is no OpenCL device '{}'; there is {}", from, wish, names_of(devices));
}

Device::Device(std::string_view wish) {
    const auto devices = raw_devices();
    const auto known = described(devices);
    info_ = known[choose_device(known, wish)];
    device_ = devices.at(info_.index);
    try {
        context_ = cl::Context(device_);
        queue_ = cl::CommandQueue(context_, device_);
    } catch (const cl::Error& e) {
        raise(info_, "opening it", e);
    }
    // PoCL allocates memory that the host reaches at once, and reports there where there is too little; other memory it allocates
    // at first use, and ends the process.
    memory_ = std::make_shared<MemoryPool>(
        context_, CL_MEM_READ_WRITE | (info_.shares_memory ? cl_mem_flags{CL_MEM_ALLOC_HOST_PTR} : 0),
        info_.max_allocation);
    programs_ = std::make_unique<ProgramCache>(context_, device_);
}

/// What was begun ends first: PoCL aborts a process that leaves while it still compiles.
Device::~Device() {
    if (queue_()) clFinish(queue_());
}

Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

cl::Kernel Device::kernel(std::string_view file, const std::string& name, const std::string& options) {
    const auto text = source(file);
    if (text.empty()) throw Error("no OpenCL source is called {}.cl", file);
    return kernel_from(text, fmt::format("{}.cl", file), name, options);
}

cl::Kernel Device::vector_kernel(std::string_view file, const std::string& name, std::uint32_t vec,
                                 const std::string& options) {
    return kernel_from(std::string(source("vectors")) + std::string(source(file)), fmt::format("{}.cl", file),
                       name, fmt::format("-DVEC={}{}", vec, options));
}

cl::Kernel Device::kernel_from(std::string_view text, std::string_view label, const std::string& name,
                               const std::string& options) {
    const auto program = programs_->get(text, label, options);
    try {
        return {program, name.c_str()};
    } catch (const cl::Error& e) {
        raise(info_, fmt::format("making kernel {} of {}", name, label), e);
    }
}

std::array<std::size_t, 2> group_size(const Device& device, const cl::Kernel& kernel,
                                      std::array<std::size_t, 2> range, std::size_t wanted) {
    const auto target = std::min(wanted, kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device.handle()));
    const auto most = device.handle().getInfo<CL_DEVICE_MAX_WORK_ITEM_SIZES>();  // three at least
    const std::size_t x = std::min({target, std::bit_ceil(range[0]), most[0]});
    return {x, std::max<std::size_t>(1, std::min({target / x, std::bit_ceil(range[1]), most[1]}))};
}

void raise(const DeviceInfo& device, std::string_view what, const cl::Error& error) {
    switch (error.err()) {
        case CL_OUT_OF_RESOURCES:  // memory for the most part, and less of it may do; but drivers say so of other things, too
            throw OutOfMemory(
                "device {} ({}): out of memory, registers or time {} (CL_OUT_OF_RESOURCES); choose another "
                "with --device (opencl= in a training)",
                device.index, device.name, what);
        case CL_MEM_OBJECT_ALLOCATION_FAILURE:
        case CL_OUT_OF_HOST_MEMORY:
        case CL_INVALID_BUFFER_SIZE:
            throw OutOfMemory(
                "device {} ({}): out of memory {}; choose another with --device (opencl= in a training) or "
                "take less at once",
                device.index, device.name, what);
        default:
            throw Error("device {} ({}): {} failed: {} says {}", device.index, device.name, what,
                        error.what(), error.err());
    }
}

}  // namespace actformer::kernels
