#include "ingest/smpl/vertex_normals.hpp"

#include <array>
#include <cmath>

namespace actformer::ingest {

std::vector<float> vertex_normals(std::span<const float> vertices, std::span<const std::uint32_t> faces) {
    std::vector<double> sums(vertices.size(), 0);
    for (std::size_t f = 0; f < faces.size(); f += 3) {
        const std::array<std::size_t, 3> v{faces[f], faces[f + 1], faces[f + 2]};
        std::array<double, 3> a{}, b{};
        for (std::size_t d = 0; d < 3; ++d) {
            a[d] = double{vertices[3 * v[1] + d]} - vertices[3 * v[0] + d];
            b[d] = double{vertices[3 * v[2] + d]} - vertices[3 * v[0] + d];
        }
        for (const auto corner : v)  // the cross product is as long as twice the area
            for (std::size_t d = 0; d < 3; ++d)
                sums[3 * corner + d] += a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
    }
    std::vector<float> out;
    out.reserve(sums.size());
    for (std::size_t i = 0; i < sums.size(); i += 3) {
        const double length = std::hypot(sums[i], sums[i + 1], sums[i + 2]);
        for (std::size_t d = 0; d < 3; ++d)
            out.push_back(static_cast<float>(length > 0 ? sums[i + d] / length : d == 1 ? 1 : 0));
    }
    return out;
}

}  // namespace actformer::ingest
