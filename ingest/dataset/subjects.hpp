// What it takes to draw motions and to name their classes: attributes that travel with weights and motions, so that the
// dataset they came from need not.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/topology.hpp"

namespace actformer::hdf5 {
class Reader;
class Writer;
}  // namespace actformer::hdf5

namespace actformer::ingest {

class Dataset;

struct Subjects {
    Topology topology;
    std::uint32_t persons = 1;
    std::vector<float> bone_length;  ///< (persons, joints) metres
    std::vector<std::string> classes;
    double fps = 30;

    bool operator==(const Subjects&) const = default;
};

/// Of a dataset, with mean limb lengths over up to 200 clips, evenly chosen. Throws Error where it has no clip.
Subjects subjects_of(const Dataset& dataset);

/// Attributes `parents`, `joints`, `persons`, `bone_length`, `class_names`, `fps`.
void write_subjects(hdf5::Writer& file, const Subjects& subjects);

/// None where the file was written without. Throws Error, beginning with `where`, where the attributes contradict one
/// another.
std::optional<Subjects> read_subjects(const hdf5::Reader& file, const std::string& where);

}  // namespace actformer::ingest
