// What a raw file of motions holds: joint positions in arrays, or motions in the public ActFormer layout.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ingest/dataset/motions_file.hpp"
#include "ingest/formats/format.hpp"
#include "ingest/formats/motions/joint_array.hpp"

namespace actformer::ingest {

/// An array, or a motion in the public layout.
struct FoundMotion {
    std::string key;          ///< its name in the file; empty for all that a file holds
    std::uint64_t clips = 1;  ///< along an axis
    bool numbered = false;    ///< there is such an axis
    std::uint32_t persons = 1;
    bool stored = false;               ///< in the public layout: limbs or rotations already
    std::vector<std::int64_t> labels;  ///< (clips) from 0, as the file tells; -1 or empty: it does not
};

/// What a look at a file tells.
struct MotionFile {
    std::vector<FoundMotion> motions;
    std::vector<std::pair<std::string, std::string>>
        faults;  ///< key, what is wrong; of the whole file: an empty key
    std::optional<Topology> topology;
    std::vector<std::string> classes;
    std::optional<double> fps;
    Representation representation;   ///< of stored motions
    std::vector<float> bone_length;  ///< (persons, joints) of stored motions; empty: not told
    std::vector<float> rest;         ///< as in BodyModel
    std::string guess;  ///< how the axes of an array were taken that could be meant otherwise; empty: none
    bool numbered_columns = false;  ///< as in CsvMotion
};

/// How to take arrays that do not say it.
struct ArrayReading {
    std::optional<Topology> topology;  ///< none: as the file tells
    std::string axes;                  ///< as JointArray takes them
};

/// Throws nothing for what is in the file.
MotionFile look_into(const RawText& raw, const ArrayReading& how);

/// Takes the motions that a look has found, in the file's order; `found` is one of file.motions.
struct MotionTaker {
    std::function<void(const FoundMotion& found, const JointArray& array)> array;
    std::function<void(const FoundMotion& found, const MotionsFile& file)> stored;
};

/// Reads the numbers of what look_into has found. `topology` is the dataset's. Throws Error, without the file's name, where the file
/// turns out to be damaged.
void take_motions(const RawText& raw, const MotionFile& file, const Topology& topology,
                  const std::string& axes, const MotionTaker& taker);

}  // namespace actformer::ingest
