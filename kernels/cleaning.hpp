// Cleaning of motion capture on the device: gap filling, smoothing, limb-vector normalisation.
//
// Filling and smoothing are linear and treat all joints alike, so they run on limbs: joint 0 is the root's position and
// joint k the vector from k's parent to k, in metres. The reader takes that difference in double: short limbs are then
// exact to float32 however far from the camera a body stands.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/buffer.hpp"

namespace actformer::kernels {

/// Many ragged clips, each of `persons` sequences of detections. Sequence s = clip * persons + person owns detections
/// first[s] .. first[s+1]-1, at least one, at rising `times`.
struct ClipBatch {
    std::uint32_t persons = 1, joints = 0;
    std::vector<std::uint32_t> frames;  ///< (clips) frames of each clip once cleaned, at least 1
    std::vector<float> step;            ///< (clips) output frame t shows time t * step
    std::vector<std::uint32_t> first;   ///< (clips * persons + 1)
    std::vector<float> times;           ///< (detections) in frames of the recording

    std::size_t clips() const { return frames.size(); }
    std::size_t total_frames() const;
};

/// Gaussian over frames; sigma 0 switches it off.
struct Smoothing {
    float sigma = 3;
    std::uint32_t radius = 12;
    std::uint32_t vec =
        0;  ///< numbers that a work-item smooths side by side: 4, 8 or 16; 0 for what suits the device
};

/// clip i's frames follow clip i-1's.
struct CleanedBatch {
    std::span<const float>
        motion;  ///< (total frames, P, K, 3): unit limbs, and the re-centred root in metres
    std::vector<float> bone_length;  ///< (clips, P, K) metres, the mean over frames; 0 for the root
    std::shared_ptr<const void>
        memory;  ///< keeps what `motion` lies in: as large as it is, it is not copied from there
};

/// Limbs of every frame on the device: values (total frames, P, pitch), the K*3 numbers of a body first; what follows them
/// in a row means nothing.
struct LimbRows {
    Buffer<float> values;
    std::uint32_t pitch = 0;
};

/// Room on the device for (detections, K, 3), and what the kernels read behind it.
Buffer<float> limb_buffer(Device& device, std::size_t detections, std::uint32_t joints);

/// Detections, in a limb_buffer, interpolated linearly at every output frame, held before the first and after the last; then
/// each coordinate smoothed over its clip's frames, edges mirrored with the edge sample repeated.
LimbRows fill_and_smooth(Device& device, const ClipBatch& batch, const Buffer<float>& limbs,
                         const Smoothing& how);

/// Each limb divided by (its length + 1e-4); the mean root over a clip's frames and persons taken from its roots.
CleanedBatch normalise(Device& device, const ClipBatch& batch, const LimbRows& limbs);

/// All of it. `limbs` is a limb_buffer.
CleanedBatch clean(Device& device, const ClipBatch& batch, const Buffer<float>& limbs, const Smoothing& how);

}  // namespace actformer::kernels
