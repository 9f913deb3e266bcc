#include "ingest/dataset/body_model.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace actformer::ingest {
namespace {

/// One body, from its nodes to its joints (joints, 3).
void joints_of_limbs(const float* limbs, const Topology& topology, const std::vector<std::uint32_t>& order,
                     const float* bone_length, float* joints) {
    for (const auto j : order) {
        const int parent = topology.parents[j];
        const float length = parent < 0 ? 1.0F : bone_length[j];
        for (std::size_t d = 0; d < 3; ++d)
            joints[j * 3 + d] = limbs[j * 3 + d] * length + (parent < 0 ? 0.0F : joints[parent * 3 + d]);
    }
}

void joints_of_rotations(const float* nodes, const Topology& topology,
                         const std::vector<std::uint32_t>& order, const std::vector<float>& rest,
                         float* joints) {
    constexpr std::size_t numbers = 6;
    const auto k = topology.joints();
    std::vector<Rotation> turned(k);  // of every joint in the world
    std::vector<std::array<double, 3>> at(k);
    for (const auto j : order) {
        const int parent = topology.parents[j];
        const auto own = rotation_of(nodes + j * numbers);
        turned[j] = parent < 0 ? own : product(turned[parent], own);
        for (std::size_t d = 0; d < 3; ++d) {
            const float* offset = &rest[j * 3];
            if (parent < 0) {
                at[j][d] = static_cast<double>(nodes[k * numbers + d]) + offset[d];
            } else {
                const double* row = &turned[parent][d * 3];
                at[j][d] = at[parent][d] + row[0] * offset[0] + row[1] * offset[1] + row[2] * offset[2];
            }
            joints[j * 3 + d] = static_cast<float>(at[j][d]);
        }
    }
}

}  // namespace

void check_fits(const Motion& motion, const BodyModel& body) {
    const auto& how = body.representation;
    const auto joints = body.topology.joints();
    if (motion.nodes != how.nodes(body.topology) || motion.numbers != how.numbers())
        throw Error("{} has {} nodes of {} numbers; {} of {} joints has {} of {}", motion.name, motion.nodes,
                    motion.numbers, how.name(), joints, how.nodes(body.topology), how.numbers());
    if (how == Representation::limb && (body.bone_length.empty() || body.bone_length.size() % joints != 0))
        throw Error("{}: {} limb lengths for {} joints", motion.name, body.bone_length.size(), joints);
    if (how == Representation::rot6d && body.rest.size() != joints * 3)
        throw Error("{}: a rest skeleton of {} numbers for {} joints; rotations need 3 a joint", motion.name,
                    body.rest.size(), joints);
}

std::vector<float> joint_positions(const Motion& motion, const BodyModel& body) {
    check_fits(motion, body);
    if (body.representation == Representation::xyz) return motion.values;
    const auto joints = body.topology.joints();
    const auto order = body.topology.order();
    std::vector<float> out(std::size_t{motion.frames} * motion.persons * joints * 3);
    float* to = out.data();
    for (std::size_t t = 0; t < motion.frames; ++t)
        for (std::size_t p = 0; p < motion.persons; ++p, to += joints * 3)
            if (body.representation == Representation::rot6d) {
                joints_of_rotations(motion.at(t, p, 0), body.topology, order, body.rest, to);
            } else {
                const auto known = body.bone_length.size() / joints;
                joints_of_limbs(motion.at(t, p, 0), body.topology, order,
                                &body.bone_length[p < known ? p * joints : 0], to);
            }
    return out;
}

Rotation rotation_of(const float* six) {
    const auto unit = [](std::array<double, 3> v) {
        const double length = std::max(std::hypot(v[0], v[1], v[2]), 1e-12);
        for (auto& x : v) x /= length;
        return v;
    };
    const auto a = unit({six[0], six[1], six[2]});
    const double along = a[0] * six[3] + a[1] * six[4] + a[2] * six[5];
    const auto b = unit({six[3] - along * a[0], six[4] - along * a[1], six[5] - along * a[2]});
    return {a[0],
            a[1],
            a[2],
            b[0],
            b[1],
            b[2],
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0]};
}

}  // namespace actformer::ingest
