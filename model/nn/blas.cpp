#include "model/nn/blas.hpp"

#include <ATen/ATen.h>
#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>
#include <dlfcn.h>
#include <sched.h>
#include <sys/mman.h>
#include <torch/version.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "base/error.hpp"
#include "base/process/memory_limit.hpp"
#include "base/process/processor_level.hpp"
#include "base/threads/thread.hpp"

namespace actformer::model {
namespace {

/// Of a product of two 384 x 384 matrices, the best of several.
double measured_gflops() {
    using Clock = std::chrono::steady_clock;
    constexpr std::int64_t n = 384;
    const at::NoGradGuard no_gradients;
    const auto a = at::ones({n, n}), b = at::ones({n, n});
    double best = 1e9;
    for (int i = 0; i < 6; ++i) {
        const auto start = Clock::now();
        const auto c = a.mm(b);
        best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
    }
    return 2.0 * n * n * n / best / 1e9;
}

/// The file behind the name "libblas.so.3" decides, and Debian's alternatives make it a link.
std::string library_of_sgemm() {
    void* symbol = dlsym(RTLD_DEFAULT, "sgemm_");
    Dl_info info{};
    if (!symbol || dladdr(symbol, &info) == 0 || !info.dli_fname) return {};
    std::error_code error;
    const auto path = std::filesystem::canonical(info.dli_fname, error);
    return error ? info.dli_fname : path.string();
}

std::string openblas_core() {
    using Name = char* (*)();
    const auto name = reinterpret_cast<Name>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
    return name ? name() : "";
}

/// What OpenBLAS calls a processor with the wide vectors that this one has and `core` has not; empty for others.
std::string_view newer_core(std::string_view core) {
    if (core != "Prescott" && core != "Nehalem") return {};
    for (const auto& level : processor_levels())
        if (level.runs && level.name != "v2") return level.openblas;
    return {};
}

/// OMP_NUM_THREADS; of a list the first. 0 where it is not set, or no number of threads.
int threads_asked_for() {
    const char* text = std::getenv("OMP_NUM_THREADS");
    if (!text) return 0;
    int threads = 0;
    std::from_chars(text, text + std::strlen(text), threads);
    return std::clamp(threads, 0, 1024);
}

/// Throws Error where a limit on memory leaves no room for the buffers of OpenBLAS's own threads and of `threads` that call it. Its own may
/// have theirs by now: then this asks for more than is needed, and never for less.
void expect_openblas_buffers(int threads) {
    if (!memory_is_limited()) return;
    using Count = int (*)();
    const auto own = reinterpret_cast<Count>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
    const auto bytes = static_cast<std::size_t>((own ? own() : 1) + threads) * openblas_buffer;
    void* const room =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED)
        throw Error(
            "not enough memory for matrix products: OpenBLAS maps {} MiB a thread; raise the limit (ulimit "
            "-v), or let it have fewer threads (OMP_NUM_THREADS=1)",
            openblas_buffer >> 20);
    ::munmap(room, bytes);
}

/// Lets OpenBLAS take its buffer for this thread now. It asks for it at the first product, and again without end where it gets none.
void take_openblas_buffer(int threads) {
    if (library_of_sgemm().find("openblas") == std::string::npos) return;
    expect_openblas_buffers(threads);
    constexpr std::int64_t n = 128;  // it multiplies smaller ones without
    const at::NoGradGuard no_gradients;
    at::ones({n, n}).mm(at::ones({n, n}));
}

}  // namespace

BlasCheck check_blas() {
    BlasCheck check;
    check.library = library_of_sgemm();
    if (check.library.find("openblas") != std::string::npos) check.core = openblas_core();
    check.gflops = measured_gflops();
    auto speed = fmt::format("libtorch {}, {} thread{}, matrix products at {:.0f} GFLOP/s", TORCH_VERSION,
                             at::get_num_threads(), at::get_num_threads() == 1 ? "" : "s", check.gflops);
    const bool reference = check.library.find("/blas/libblas") != std::string::npos;
    const auto newer = newer_core(check.core);
    check.slow = reference || !newer.empty();
    if (reference)
        check.line =
            speed + ": " + check.library + " is the slow reference BLAS; install libopenblas0-pthread";
    else if (!newer.empty())
        check.line = fmt::format("{}: OpenBLAS takes this processor for a {}; set OPENBLAS_CORETYPE={}",
                                 speed, check.core, newer);
    else
        check.line = speed + (check.core.empty() ? "" : ", OpenBLAS for " + check.core);
    return check;
}

int set_threads(int threads) {
    if (threads == 0) threads = threads_asked_for();
    if (threads == 0) {
        cpu_set_t allowed;
        threads = sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 1;
    }
    take_openblas_buffer(threads);
    expect_threads(static_cast<unsigned>(threads));  // OpenMP ends the process where it is refused one
    at::set_num_threads(threads);
    return threads;
}

}  // namespace actformer::model
