// Built OpenCL programs, kept for the life of a device. (PoCL and the GPU drivers keep their own on disk.)
#pragma once

#include <CL/opencl.hpp>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace actformer::kernels {

/// Programs of one device, keyed by source text and build options. Safe from many threads.
class ProgramCache {
  public:
    ProgramCache(cl::Context context, cl::Device device)
        : context_(std::move(context)), device_(std::move(device)) {}

    /// Throws Error with `label` and the compiler's log where the source does not build.
    cl::Program get(std::string_view source, std::string_view label, const std::string& options);

    std::size_t size() const { return programs_.size(); }

  private:
    cl::Context context_;
    cl::Device device_;
    std::mutex mutex_;
    std::map<std::pair<std::string, std::string>, cl::Program> programs_;
};

}  // namespace actformer::kernels
