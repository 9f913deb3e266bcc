#include "ingest/dataset/known_topologies.hpp"

namespace actformer::ingest {

const std::vector<KnownTopology>& known_topologies() {
    static const std::vector<KnownTopology> all{
        {"ntu25", ntu25()},
        {"smpl24", smpl24()},
        // COCO's 17 key points, the nose for a root
        {"coco17",
         {{"nose", "left eye", "right eye", "left ear", "right ear", "left shoulder", "right shoulder",
           "left elbow", "right elbow", "left wrist", "right wrist", "left hip", "right hip", "left knee",
           "right knee", "left ankle", "right ankle"},
          {-1, 0, 0, 1, 2, 0, 0, 5, 6, 7, 8, 5, 6, 11, 12, 13, 14}}},
        // the 17 of Human3.6M as VideoPose3D orders them
        {"h36m17",
         {{"pelvis", "right hip", "right knee", "right ankle", "left hip", "left knee", "left ankle", "spine",
           "thorax", "neck", "head", "left shoulder", "left elbow", "left wrist", "right shoulder",
           "right elbow", "right wrist"},
          {-1, 0, 1, 2, 0, 4, 5, 0, 7, 8, 9, 8, 11, 12, 8, 14, 15}}},
        {"gta22", gta22()},
        {"common15", common15()}};
    return all;
}

const Topology& smpl24() {
    static const Topology topology{
        {"pelvis",     "left hip",    "right hip",    "spine1",      "left knee",     "right knee",
         "spine2",     "left ankle",  "right ankle",  "spine3",      "left foot",     "right foot",
         "neck",       "left collar", "right collar", "head",        "left shoulder", "right shoulder",
         "left elbow", "right elbow", "left wrist",   "right wrist", "left hand",     "right hand"},
        {smpl24_parents.begin(), smpl24_parents.end()}};
    return topology;
}

const Topology& gta22() {
    static const Topology topology{
        {"pelvis",      "head center",   "neck",          "right clavicle", "right shoulder", "right elbow",
         "right wrist", "left clavicle", "left shoulder", "left elbow",     "left wrist",     "spine0",
         "spine1",      "spine2",        "spine3",        "head top",       "right hip",      "right knee",
         "right ankle", "left hip",      "left knee",     "left ankle"},
        {gta22_parents.begin(), gta22_parents.end()}};
    return topology;
}

const Topology& common15() {
    static const Topology topology{{"pelvis", "neck", "head", "left shoulder", "left elbow", "left wrist",
                                    "right shoulder", "right elbow", "right wrist", "left hip", "left knee",
                                    "left ankle", "right hip", "right knee", "right ankle"},
                                   {-1, 0, 1, 1, 3, 4, 1, 6, 7, 0, 9, 10, 0, 12, 13}};
    return topology;
}

}  // namespace actformer::ingest
