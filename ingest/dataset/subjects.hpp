// The skeleton, limb lengths and class names of motions: attributes of weights and motions files, which are then of use
// without the dataset they came from.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/body_model.hpp"

namespace actformer::hdf5 {
class Reader;
class Writer;
}  // namespace actformer::hdf5

namespace actformer::ingest {

class Dataset;
struct DatasetHeader;

/// The body model's bone lengths may be missing.
struct Subjects : BodyModel {
    std::uint32_t persons = 1;
    std::vector<std::string> classes;
    double fps = 30;

    bool operator==(const Subjects&) const = default;
};

/// Of a dataset, with mean limb lengths over up to 200 clips, evenly chosen. Throws Error where it has no clip.
Subjects subjects_of(const Dataset& dataset);

/// Attributes `representation`, `parents`, `names`, `persons`, `bone_length`, `rest`, `classes`, `fps`; those without
/// numbers are left out.
void write_subjects(hdf5::Writer& file, const Subjects& subjects);

/// Throws Error where the names of classes or joints are more than such attributes hold.
void check_names_fit(const DatasetHeader& header);

/// The attribute `representation`; none where the file was written without. Throws Error, beginning with `where`, for one that is
/// not known.
std::optional<Representation> read_representation(const hdf5::Reader& file, const std::string& where);

/// None where the file does not tell its `parents`. Where others of the attributes are missing: limbs, joints called by their
/// number, one person or as many as have bone lengths, 30 frames a second. Throws Error, beginning with `where`, where the attributes contradict one another.
std::optional<Subjects> read_subjects(const hdf5::Reader& file, const std::string& where);

}  // namespace actformer::ingest
