// Which motions to draw: from a dataset, a motions file in the public layout, or a raw NTU capture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/motions/joint_motion.hpp"

namespace actformer::reports {

struct Wanted {
    std::vector<std::string> clips;  ///< by name; empty: picked over the classes
    std::string split = "all";       ///< of datasets
    std::string label;               ///< a class, as ingest::label_called takes it; empty: any
    std::size_t count = 6;           ///< motions to pick
    std::size_t per_class = 0;       ///< of every class, in its place; 0 picks `count` in all
    std::filesystem::path
        bones;  ///< dataset whose skeleton and mean limb lengths a motions file is drawn with; empty: its own
    std::shared_ptr<const BodySkin> body;  ///< drawn on rotations of SMPL's joints; null: limbs are drawn
};

/// The motions wanted of what lies at `path`. `there` becomes how many they were picked from, of the split and class that are wanted.
/// Throws Error naming `path` and what it lacks.
std::vector<JointMotion> gather(const std::filesystem::path& path, const Wanted& wanted,
                                std::size_t* there = nullptr);

}  // namespace actformer::reports
