#include "ingest/smpl/smpl24.hpp"

namespace actformer::ingest {

RestSkeleton generic_skeleton() {
    constexpr double hip = 0.0916, collar = 0.060, shoulder = 0.124, elbow = 0.296, wrist = 0.185,
                     hand = 0.080;
    return {{0,        0,     0,      hip,       -0.100, 0.020,  -hip,    -0.100, 0.020,  // pelvis, hips
             0,        0.078, -0.004, 0,         -0.404, 0,      0,       -0.404, 0,      // spine1, knees
             0,        0.078, -0.004, 0,         -0.428, 0,      0,       -0.428, 0,      // spine2, ankles
             0,        0.078, -0.004, 0,         -0.030, 0.117,  0,       -0.030, 0.117,  // spine3, feet
             0,        0.093, -0.012, collar,    0.040,  0,      -collar, 0.040,  0,      // neck, collars
             0,        0.093, -0.012,                                                     // head
             shoulder, 0.020, -0.008, -shoulder, 0.020,  -0.008,                          //
             elbow,    0,     0,      -elbow,    0,      0,      wrist,   0,      0,      //
             -wrist,   0,     0,      hand,      0,      0,      -hand,   0,      0},
            "generic"};
}

}  // namespace actformer::ingest
