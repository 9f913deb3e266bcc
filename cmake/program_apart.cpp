// A program that is a library beside it, PROGRAM.so, opened so that nobody else sees what it and its own libraries export.
#include <dlfcn.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace {

/// The OpenBLAS core with this processor's vectors; null where there are none to speak of.
const char* core_by_vectors() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq"))
        return "SkylakeX";
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
    return nullptr;
}

/// OpenBLAS takes a processor newer than itself for one of 2004, and multiplies at a fraction of its speed. What it shall take it for
/// it reads when it is opened, so it is asked by itself, which takes milliseconds, and the program starts once more where that helps.
void start_again_with_vectors(const char* program, char** argv) {
    void* const blas = ::dlopen("libblas.so.3", RTLD_LAZY | RTLD_LOCAL);  // as libtorch will
    using Name = char*();
    auto* const name = blas ? reinterpret_cast<Name*>(::dlsym(blas, "openblas_get_corename")) : nullptr;
    const auto* const better = core_by_vectors();
    if (!name || !better) return;
    const std::string_view core = name();
    if (core != "Prescott" && core != "Nehalem") return;
    if (::setenv("OPENBLAS_CORETYPE", better, 0) == 0) ::execv(program, argv);
}

}  // namespace

int main(int argc, char** argv) {
    std::error_code unread;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", unread).string();
    if (!std::getenv("OPENBLAS_CORETYPE")) start_again_with_vectors(program.c_str(), argv);
    const auto rest = program + ".so";
    void* const library = ::dlopen(rest.c_str(), RTLD_NOW | RTLD_LOCAL);
    using Main = int(int, char**);
    auto* const main_of_it = library ? reinterpret_cast<Main*>(::dlsym(library, "main")) : nullptr;
    if (main_of_it) return main_of_it(argc, argv);
    std::fprintf(stderr, "actformer: %s; build or install it again\n", ::dlerror());
    return 1;
}
