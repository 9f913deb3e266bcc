#include "ingest/formats/gta/gta_skeleton.hpp"

namespace actformer::ingest {

const Topology& gta22() {
    static const Topology topology{
        {"pelvis",      "head center",   "neck",          "right clavicle", "right shoulder", "right elbow",
         "right wrist", "left clavicle", "left shoulder", "left elbow",     "left wrist",     "spine0",
         "spine1",      "spine2",        "spine3",        "head top",       "right hip",      "right knee",
         "right ankle", "left hip",      "left knee",     "left ankle"},
        {gta22_parents.begin(), gta22_parents.end()}};
    return topology;
}

std::vector<float> gta_bone_lengths() {
    return {0,      0.114F, 0.244F, 0.0585F, 0.166F, 0.267F, 0.253F, 0.0585F, 0.166F, 0.267F, 0.253F,
            0.116F, 0.074F, 0.071F, 0.023F,  0.114F, 0.118F, 0.411F, 0.404F,  0.118F, 0.411F, 0.404F};
}

}  // namespace actformer::ingest
