#include "kernels/peak.hpp"

#include <algorithm>
#include <chrono>

#include "kernels/buffer.hpp"
#include "kernels/sources.hpp"

namespace actformer::kernels {

double measure_peak(Device& device, std::uint32_t vec, int repeats) {
    constexpr std::uint32_t chains = 12;
    const bool cpu = device.info().type == "CPU";
    const std::size_t group = cpu ? 1 : 128, items = device.info().compute_units * (cpu ? 8 : 32) * group;
    const std::uint32_t steps = cpu ? 50'000 : 4'000;
    auto kernel = device.vector_kernel("peak", "peak", vec, fmt::format(" -DCHAINS={}", chains));
    const Buffer<float> out(device, items + group);
    double best = 0;
    for (int i = 0; i <= repeats; ++i) {  // the first run builds the kernel for this size of group
        const auto start = std::chrono::steady_clock::now();
        launch(device, kernel, {items, 1, 1}, group, out, steps);
        device.queue().finish();
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (i > 0) best = std::max(best, 2.0 * chains * vec * steps * static_cast<double>(items) / seconds);
    }
    return best;
}

}  // namespace actformer::kernels
