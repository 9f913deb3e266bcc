// An array of joint positions, whatever the order of its axes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/numpy/npy.hpp"

namespace actformer::ingest {

class JointArray {
  public:
    /// `axes` has a letter an axis: n clips, t frames, p persons, k joints, c coordinates; n and p may be missing, kc may share an axis
    /// (then c is left out). Empty: (t,k,c), (t,kc), (n,t,p,k,c), and of four axes (t,p,k,c) where the second is at most 6 and not
    /// longer than the first, else (n,t,k,c). Throws Error, naming the shape, where the array does not have that shape with `joints`
    /// joints and three coordinates.
    JointArray(const NumpyArray& array, std::size_t joints, const std::string& axes);

    std::uint64_t clips() const { return clips_; }
    std::uint64_t frames() const { return frames_; }
    std::uint64_t persons() const { return persons_; }
    std::size_t joints() const { return joints_; }
    bool has_clips() const { return has_clips_; }  ///< an axis of clips
    bool guessed() const { return guessed_; }      ///< another order of its four axes would have fitted too

    /// Where the numbers end that nobody needs once this clip and those before it are read.
    const char* end_of_clip(std::uint64_t clip) const;

    /// The bodies of a clip from `frame` on, (frames, persons, joints, 3), where they lie in memory as just that; else null.
    const float* as_it_lies(std::uint64_t clip, std::uint64_t frame) const;

    /// (joints, 3) positions of a body.
    void pose(std::uint64_t clip, std::uint64_t frame, std::uint64_t person, double* to) const;

  private:
    void take_axis(char letter, std::uint64_t length, std::uint64_t stride);

    const NumpyArray* array_;
    std::size_t joints_;
    std::uint64_t clips_ = 1, frames_ = 1, persons_ = 1;
    std::uint64_t of_clip_ = 0, of_frame_ = 0, of_person_ = 0, of_joint_ = 0,
                  of_coordinate_ = 0;  ///< strides in elements
    bool has_clips_ = false, guessed_ = false;
};

/// Throws Error showing the right form unless `axes` is empty or one of those that JointArray takes.
void check_axes(const std::string& axes);

}  // namespace actformer::ingest
