// Levels of x86-64 as its ABI has them. Needs nothing of the project, and no instruction that an old processor has not.
#pragma once

#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace actformer {

struct ProcessorLevel {
    std::string_view name, march;  ///< in short, and as the compiler has it
    bool runs;                     ///< on this processor
    const char* openblas;          ///< what OpenBLAS calls a processor with its vectors
};

#if defined(__x86_64__)
/// MOVBE, F16C and LZCNT, by the bits of CPUID that Intel's and AMD's manuals give them: not every compiler knows their names.
inline bool has_movbe_f16c_lzcnt() {
    unsigned a = 0, b = 0, c = 0, d = 0;
    const bool basic = __get_cpuid(1, &a, &b, &c, &d) != 0 && (c >> 22 & 1U) != 0 && (c >> 29 & 1U) != 0;
    return basic && __get_cpuid(0x80000001U, &a, &b, &c, &d) != 0 && (c >> 5 & 1U) != 0;
}
#endif

/// The best first.
inline std::array<ProcessorLevel, 3> processor_levels() {
#if defined(__x86_64__)
    const bool v2 = __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.2") &&
                    __builtin_cpu_supports("popcnt");
    const bool v3 = v2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") && has_movbe_f16c_lzcnt();
    const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
#else
    const bool v2 = false, v3 = false, v4 = false;
#endif
    return {{{"v4", "x86-64-v4", v4, "SkylakeX"},
             {"v3", "x86-64-v3", v3, "Haswell"},
             {"v2", "x86-64-v2", v2, "Nehalem"}}};
}

/// Ends the program with a line where it was built for `march` and this processor is older; what is no level is taken at its word.
inline void expect_processor(std::string_view march) {
    for (const auto& level : processor_levels())
        if (level.march == march && !level.runs) {
            std::fprintf(
                stderr,
                "actformer: this processor is older than %s, which the program was built for; build it "
                "from its sources\n",
                level.march.data());
            std::exit(1);
        }
}

}  // namespace actformer
