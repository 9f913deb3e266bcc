// Skinned bodies with shapes and pose blend shapes on the device, as SMPL has them (Loper et al. 2015): joints and vertices for
// rotations, shape and translation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/buffer.hpp"

namespace actformer::kernels {

/// What moves a vertex: so much of this joint's transform.
struct Influence {
    std::uint32_t joint = 0;
    float weight = 0;
};

/// K joints at rest, and what B shapes make of them. Metres.
struct RestJoints {
    std::vector<int> parents;    ///< (K) -1 for joint 0, the root; every joint behind its parent
    std::vector<double> places;  ///< (K, 3) of the mean body
    std::vector<double> shapes;  ///< (B, K, 3) what a shape parameter of 1 adds

    std::size_t count() const { return parents.size(); }
    std::size_t shape_count() const { return places.empty() ? 0 : shapes.size() / places.size(); }

    /// (K, 3) of the body of these shape parameters; those that are not given are 0. Throws Error for more than there are shapes.
    std::vector<double> shaped(std::span<const float> betas) const;
};

/// A body model's numbers: V vertices on K joints. Metres.
struct SkinnedBody {
    RestJoints joints;
    std::vector<float> rest;    ///< (V, 3) of the mean body
    std::vector<float> shapes;  ///< (B, V, 3) what a shape parameter of 1 adds
    std::vector<float>
        pose_directions;  ///< (V, 3, 9 (K - 1)) what a number of R - I of the joints behind the root adds
    std::vector<std::uint32_t> first;  ///< (V + 1) vertex v has influences first[v] .. first[v + 1] - 1
    std::vector<Influence> influences;

    std::size_t vertices() const { return rest.size() / 3; }
};

/// Sizes that the kernels are built with (skinning.cl).
struct SkinningTiles {
    std::uint32_t vec = 16;      ///< frames in a vector: 1, 2, 4, 8 or 16
    std::uint32_t vertices = 4;  ///< whose sums a work-item holds
    std::uint32_t vectors = 2;   ///< of frames, for each of these sums
    std::uint32_t blocks = 32;   ///< of so many vertices that a work-item does one after the other
    std::uint32_t panel = 32;    ///< frames that lie together, a multiple of vec * vectors
    std::uint32_t group = 1;     ///< work-items in a group along frames, at most
};

/// What does well on devices of this kind.
SkinningTiles skinning_tiles(const Device& device);

/// One body on one device. Calls may come from one thread at a time.
class Skinning {
  public:
    /// The mean shape, until shape() is called. Throws Error where the body's arrays do not fit together.
    Skinning(Device& device, const SkinnedBody& body) : Skinning(device, body, skinning_tiles(device)) {}
    Skinning(Device& device, const SkinnedBody& body, const SkinningTiles& tiles);

    /// Shape parameters that are not given are 0. Throws Error for more than there are shapes.
    void shape(std::span<const float> betas);

    /// Poses `rotations` (frames, K, 3, 3), each joint's below its parent, and moves the whole by `translations` (frames, 3). A frame
    /// takes 12 V bytes of the device's memory.
    void pose(std::span<const float> rotations, std::span<const float> translations);

    std::size_t frames() const { return frames_; }

    /// (frames, K, 3), (frames, V, 3) metres, of the frames posed last; what follows them means nothing.
    const Buffer<float>& joints() const { return places_; }
    const Buffer<float>& vertices() const { return vertices_; }

  private:
    cl::Kernel kernel(const char* name);

    Device* device_;
    RestJoints body_;
    std::uint32_t vertex_count_;
    SkinningTiles tiles_;
    std::uint32_t blocks_;  ///< of vertices
    std::size_t frames_ = 0;
    cl::Kernel shape_, chain_, skin_;
    Buffer<float> rest_, shapes_, shaped_, directions_, weights_;  ///< as skinning.cl has them
    Buffer<std::int32_t> parents_;
    Buffer<std::uint32_t> first_, influencing_;
    Buffer<float> rest_joints_, features_, transforms_, places_, vertices_;
};

}  // namespace actformer::kernels
