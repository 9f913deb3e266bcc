// A program that is a library, PROGRAM.so, opened so that nobody else sees what it and its own libraries export. Beside it may lie
// builds of that library for newer processors, x86-64-v3/PROGRAM.so say: the best that this processor can run is opened, or the one that
// ACTFORMER_ISA names.
#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

#include "base/process/memory_limit.hpp"
#include "base/process/processor_level.hpp"

using actformer::memory_is_limited;
using actformer::processor_levels;

namespace {

constexpr const char* least_march = ACTFORMER_LEAST;

[[noreturn]] void fail(const std::string& why) {
    std::fprintf(stderr, "actformer: %s\n", why.c_str());
    std::exit(1);
}

/// Whether the program was built for this processor beside its own.
bool has_build_for(std::string_view march) {
    const std::string_view all = ":" ACTFORMER_LEVELS ":";
    return all.find(':' + std::string(march) + ':') != std::string_view::npos;
}

/// Of the builds beside `program`, the one to open.
std::string library_of(const std::filesystem::path& program) {
    const auto name = program.filename().string() + ".so";
    const auto least = (program.parent_path() / name).string();
    const char* asked = std::getenv("ACTFORMER_ISA");
    if (asked && !*asked) asked = nullptr;
    for (const auto& level : processor_levels()) {
        if (asked ? asked != level.name : !level.runs) continue;
        if (!level.runs) fail("ACTFORMER_ISA=" + std::string(asked) + ": this processor cannot run that");
        if (level.march == least_march) return least;
        const auto built = program.parent_path() / level.march / name;
        std::error_code unread;
        if (has_build_for(level.march) && std::filesystem::is_regular_file(built, unread))
            return built.string();
    }
    if (asked) fail("ACTFORMER_ISA=" + std::string(asked) + ": there is no such build here; leave it out");
    return least;
}

/// OpenBLAS takes a processor newer than itself for one of 2004, and multiplies at a fraction of its speed. What it shall take it for
/// it reads when it is opened, so it is asked by itself, which takes milliseconds, and the program starts once more where that helps.
void start_again_with_vectors(const char* program, char** argv) {
    void* const blas = ::dlopen("libblas.so.3", RTLD_LAZY | RTLD_LOCAL);  // as libtorch will
    using Name = char*();
    auto* const name = blas ? reinterpret_cast<Name*>(::dlsym(blas, "openblas_get_corename")) : nullptr;
    const std::string_view core = name ? name() : "";
    if (core != "Prescott" && core != "Nehalem") return;
    for (const auto& level : processor_levels())
        if (level.runs && core != level.openblas) {
            if (::setenv("OPENBLAS_CORETYPE", level.openblas, 0) == 0) ::execv(program, argv);
            return;
        }
}

/// Ends the program where a library that is being opened runs out of memory: nobody can catch what it throws.
[[noreturn]] void fail_for_want_of_memory() {
    std::fputs("actformer: not enough memory to load the program's libraries; raise the limit (ulimit -v)\n",
               stderr);
    std::_Exit(1);
}

/// How many threads OpenBLAS will make.
std::size_t openblas_threads() {
    for (const auto* name : {"OPENBLAS_NUM_THREADS", "GOTO_NUM_THREADS", "OMP_NUM_THREADS"})
        if (const char* count = std::getenv(name)) {
            const auto said = std::strtoul(count, nullptr, 10);
            if (said > 0 && said <= 1024) return said;
        }
    return std::max(1U, std::thread::hardware_concurrency());
}

/// Under a limit on memory OpenBLAS comes first, while there is room: each of its threads asks for a buffer as it is loaded, again and again
/// without end where it gets none. The other libraries say so.
void load_openblas_in_little_memory() {
    constexpr std::size_t itself = std::size_t{96} << 20;
    const auto bytes = openblas_threads() * actformer::openblas_buffer + itself;
    void* const room = ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED)
        fail(
            "not enough memory for OpenBLAS, which maps 128 MiB a thread; raise the limit (ulimit -v), or "
            "let it "
            "have fewer threads (OMP_NUM_THREADS=1)");
    ::munmap(room, bytes);
    ::setenv("UCX_LOG_LEVEL", "fatal", 0);  // what it says of threads that it cannot have is no line of ours
    ::dlopen("libblas.so.3", RTLD_LAZY | RTLD_LOCAL);
}

/// For on_exit(3): without the libraries' own ends. OpenBLAS's waits for its threads, and these wait for memory that they cannot get.
void end_now(int code, void*) {
    std::fflush(nullptr);
    std::_Exit(code);
}

}  // namespace

int main(int argc, char** argv) {
    actformer::expect_processor(least_march);
    std::error_code unread;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", unread);
    const auto usual = std::set_terminate(fail_for_want_of_memory);
    if (memory_is_limited()) load_openblas_in_little_memory();
    if (!std::getenv("OPENBLAS_CORETYPE")) start_again_with_vectors(program.c_str(), argv);
    void* const library = ::dlopen(library_of(program).c_str(), RTLD_NOW | RTLD_LOCAL);
    std::set_terminate(usual);
    if (memory_is_limited()) ::on_exit(end_now, nullptr);
    using Main = int(int, char**);
    auto* const main_of_it = library ? reinterpret_cast<Main*>(::dlsym(library, "main")) : nullptr;
    if (main_of_it) return main_of_it(argc, argv);
    std::fprintf(stderr, "actformer: %s; %s\n", ::dlerror(),
                 memory_is_limited() ? "raise the limit on memory (ulimit -v), or build or install it again"
                                     : "build or install it again");
    return 1;
}
