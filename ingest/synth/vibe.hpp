// What VIBE (Kocabas et al. 2020) tells of a person in a video, for the stand-ins of NTU-13 and UESTC: float32, y down.
#pragma once

#include <vector>

#include "ingest/synth/smpl/smpl_motion.hpp"

namespace actformer::ingest::synth {

/// One person's track, in the arrays of VIBE's output.
struct VibeTrack {
    std::uint64_t frames = 0;
    std::vector<float> pose;      ///< (frames, 72) rad
    std::vector<float> joints3d;  ///< (frames, 49, 3) metres from the pelvis
    std::vector<float> pred_cam;  ///< (frames, 3) scale and place in the box
    std::vector<float>
        orig_cam;  ///< (frames, 4) sx sy tx ty in the image: weak perspective, focal length 500, 960 x 540 pixels
    std::vector<double> bboxes;  ///< (frames, 4) cx cy w h, pixels
};

/// `motion` is in the camera's axes, y down, and before it: z above 0.
VibeTrack vibe_track(const SmplMotion& motion);

/// VIBE's 49 joints: OpenPose's 25 and 24 of other datasets. Faces, heels and toes are put where they are in an adult.
std::vector<Vec> vibe_joints(const SmplPose& pose);

}  // namespace actformer::ingest::synth
