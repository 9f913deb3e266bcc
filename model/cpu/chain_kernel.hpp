// Joints out of rotations along chains of bones, forward and backward, many poses at a time. T float or double.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace actformer::model::cpu {

struct Chains {
    /// Joints along each chain, at most most_links of them. Every joint but the root is one chain's beyond its first, and chains come
    /// in an order in which a first joint is known.
    std::vector<std::vector<int>> joints;
    std::vector<std::array<float, 3>> directions;  ///< (joints) unit vectors; zeros for the root
    std::vector<int> parents;                      ///< along the chains; -1 for the root

    std::int64_t count() const { return static_cast<std::int64_t>(directions.size()); }

    static constexpr std::size_t most_links = 8;
};

/// poses (rows, 3J): the root's position, then one axis times angle a joint, at most 2 pi; bones (rows, J) lengths -> joints
/// (rows, 3J). Every chain begins with R = I; along it R = R exp(w_j), p_j = p_before + R (length_j direction_j). Rodrigues' formula,
/// squared angles at least 1e-4 (Action2Motion, section 3.3, as published).
template <typename T>
void chain_kinematics(const Chains& chains, std::int64_t rows, const T* poses, const T* bones, T* joints);

/// grad (rows, 3J) to the joints -> to (rows, 3J) to the poses, overwritten; none to the bones.
template <typename T>
void chain_kinematics_backward(const Chains& chains, std::int64_t rows, const T* poses, const T* bones,
                               const T* grad, T* to);

}  // namespace actformer::model::cpu
