// Levels of x86-64 as its ABI has them. Needs nothing of the project, and no instruction that an old processor has not.
#pragma once

#include <array>
#include <string_view>

namespace actformer {

struct ProcessorLevel {
    std::string_view name, march;  ///< in short, and as the compiler has it
    bool runs;                     ///< on this processor
    const char* openblas;          ///< what OpenBLAS calls a processor with its vectors
};

/// The best first.
inline std::array<ProcessorLevel, 3> processor_levels() {
#if defined(__x86_64__)
    const bool v2 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
    const bool v3 = v2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi2");
    const bool v4 = v3 && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
    const bool v2 = false, v3 = false, v4 = false;
#endif
    return {{{"v4", "x86-64-v4", v4, "SkylakeX"},
             {"v3", "x86-64-v3", v3, "Haswell"},
             {"v2", "x86-64-v2", v2, "Nehalem"}}};
}

/// Whether this processor runs what was built for `march`; one that is no level is taken at its word.
inline bool runs_here(std::string_view march) {
    for (const auto& level : processor_levels())
        if (level.march == march) return level.runs;
    return true;
}

}  // namespace actformer
