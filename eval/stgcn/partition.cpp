#include "eval/stgcn/partition.hpp"

namespace actformer::eval {

std::array<Adjacency, 3> partition(const std::vector<int>& parents, std::uint32_t center) {
    const auto joints = parents.size();
    std::vector<char> linked(joints * joints, 0);
    for (std::size_t k = 0; k < joints; ++k) {
        linked[k * joints + k] = 1;
        if (parents[k] < 0) continue;
        const auto parent = static_cast<std::size_t>(parents[k]);
        linked[k * joints + parent] = linked[parent * joints + k] = 1;
    }
    const auto hops = [&](std::size_t k) { return k == center ? 0 : linked[k * joints + center] ? 1 : 2; };

    std::array<Adjacency, 3> parts;
    for (auto& part : parts) part.assign(joints * joints, 0.0);
    for (std::size_t w = 0; w < joints; ++w) {
        double degree = 0;
        for (std::size_t v = 0; v < joints; ++v) degree += linked[v * joints + w];
        for (std::size_t v = 0; v < joints; ++v)
            if (linked[v * joints + w])
                parts[v == w ? 0 : hops(v) >= hops(w) ? 1 : 2][v * joints + w] = 1 / degree;
    }
    return parts;
}

}  // namespace actformer::eval
