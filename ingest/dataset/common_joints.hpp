// Motions of different skeletons seen alike, so that a recogniser trained on one dataset can see those of another: GTA Combat
// has one class, and its FIDa are features of a recogniser of NTU RGB+D (ActFormer, Table 2).
#pragma once

#include <string>

#include "ingest/dataset/body_model.hpp"

namespace actformer::ingest {

/// What a reader sees of a motion's joints.
enum class Joints {
    own,      ///< as the dataset has them
    common15  ///< as CommonJoints has them, each window centred
};

/// Throws Error, naming `where`, for skeletons of which nobody knows which joints are the common ones.
void expect_common_joints(const Topology& topology, const std::string& where);

class CommonJoints {
  public:
    /// For motions of `body`. Throws Error, beginning with `where`, where its joints are not those of ntu25(), smpl24(), gta22() or
    /// common15(), or it lacks what gives their positions.
    CommonJoints(BodyModel body, const std::string& where);

    /// The motion as limbs of common15(), (frames, persons, 15, 3). Roots are relative to their mean over frames and persons. Each
    /// person's are scaled by 0.75 m / (its mean length from hip to ankle): a tall body's step and a small one's are the same action.
    Motion of(const Motion& motion) const;

    /// The same, with limb lengths of the clip at hand.
    Motion of(const Motion& motion, std::vector<float> bone_length) const;

  private:
    Motion seen(const Motion& motion, const BodyModel& body) const;

    BodyModel body_;
    const std::uint32_t* joints_;  ///< (15) of the body
};

}  // namespace actformer::ingest
