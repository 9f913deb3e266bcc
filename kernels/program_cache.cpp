#include "kernels/program_cache.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace actformer::kernels {

cl::Program ProgramCache::get(std::string_view source, std::string_view label, const std::string& options) {
    const std::lock_guard lock(mutex_);
    auto key = std::pair(std::string(source), options);
    if (const auto found = programs_.find(key); found != programs_.end()) return found->second;

    cl::Program program(context_, key.first);
    try {
        // -w: PoCL's compiler counts its warnings on standard error, as of vectors wider than the processor's.
        program.build(device_, ("-cl-std=CL1.2 -w " + options).c_str());
    } catch (const cl::Error&) {
        auto said = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device_);
        std::ranges::replace(said, '\n', ' ');
        throw Error("OpenCL kernel {} does not build on {} (options '{}'): {}", label,
                    device_.getInfo<CL_DEVICE_NAME>(), options, said);
    }
    programs_.emplace(std::move(key), program);
    return program;
}

}  // namespace actformer::kernels
