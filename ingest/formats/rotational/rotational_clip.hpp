// Rotations and translations made ready for a dataset: what all formats of SMPL's rotations share.
//
// A format reads RotationVectors out of its file, makes a RotationalMotion of them, turns it y up and cuts clips out of the
// RotationalTrack of it. RotationalTarget::header() begins its dataset, and gathered() is its clean().
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ingest/dataset/dataset.hpp"
#include "ingest/formats/format.hpp"
#include "ingest/formats/rotational/rotational_motion.hpp"

namespace actformer::ingest {

/// What rotations become, and the skeleton they turn.
struct RotationalTarget {
    Representation representation = Representation::rot6d;  ///< limb and xyz: of the skeleton's joints
    RestSkeleton skeleton = generic_skeleton();
    std::string
        of_rotations_alone{};  ///< an option that was given and speaks of rotations, as "--body"; empty: none

    /// What joints become that are taken in place of rotations: limb, or xyz where that was asked for. Throws Error where an option was
    /// given that speaks of rotations.
    Representation of_joints() const;

    /// As Format::settings() says it.
    std::string text() const;

    /// The dataset's header with representation, SMPL's topology, rest pose and origin: recorded motion of one person.
    DatasetHeader header(const std::string& name) const;
};

/// The options that `actformer ingest NAME` has for all of this.
struct RotationalOptions {
    std::string representation;  ///< empty: rot6d
    std::string body;  ///< SMPL's model file, whose mean body gives the rest skeleton; empty: the generic one

    std::vector<Option> list();  ///< bound to this object

    /// Throws Error where an option makes no sense, and as read_smpl_body does.
    RotationalTarget target() const;
};

/// Cleaned already: clips of one person need nothing of each other.
struct RotationalClip : RawClip {
    std::uint32_t frames = 0;
    std::vector<float> values;  ///< (frames, nodes, numbers)

    std::size_t bytes() const override { return sizeof *this + sizeof(float) * values.size(); }
};

/// A motion in a dataset's numbers. The body's way is kept apart, so that clips that overlap are each centred by themselves.
class RotationalTrack {
  public:
    RotationalTrack(const RotationalMotion& motion, const RotationalTarget& target);

    std::uint32_t frames() const { return frames_; }

    /// Frames `first` to `last`, which is not among them; first < last <= frames(). The mean of the translation over them is taken from
    /// it, along all three axes. Name, label and fields are left to the format.
    std::unique_ptr<RotationalClip> cut(std::uint32_t first, std::uint32_t last) const;

  private:
    Representation representation_;
    std::uint32_t frames_ = 0, nodes_ = 0;
    std::vector<double> way_;    ///< (frames, 3) metres: where translation or root is
    std::vector<float> values_;  ///< (frames, nodes, numbers), as if the body stood at the origin
};

/// What Format::clean returns for RotationalClips.
kernels::CleanedBatch gathered(std::span<const std::unique_ptr<RawClip>> clips,
                               const RotationalTarget& target, std::vector<std::uint32_t>& frames);

}  // namespace actformer::ingest
