#include "base/process/usage.hpp"

#include <sys/resource.h>

namespace actformer {
namespace {

rusage own_usage() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage;
}

}  // namespace

double processor_seconds() {
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
    };
    const auto usage = own_usage();
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_memory_mib() {
    return static_cast<double>(own_usage().ru_maxrss) / 1024;
}

}  // namespace actformer
