// A motions file together with what it takes to draw, export and name its motions, wherever that is told.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/motions_file.hpp"

namespace actformer::ingest {

class DescribedMotions {
  public:
    /// Skeleton and mean bone lengths are those of the dataset `bones` where it is given, else the file's own, else NTU's for motions
    /// of 25 nodes; usual lengths where none are known. Throws Error where no skeleton is known, where it does not fit the motions, and
    /// where a file that does not tell its representation holds no limbs.
    explicit DescribedMotions(const std::filesystem::path& path, const std::filesystem::path& bones = {});

    const MotionsFile& motions() const { return file_; }
    const Subjects& subjects() const { return subjects_; }

    /// With the motion's own bone lengths where the file tells them.
    BodyModel body(const std::string& name) const;

    /// From 0: as the file says, else of the clip of this name in `bones`, else as its own name says.
    std::optional<std::uint32_t> label(const std::string& name) const;

  private:
    Subjects find_subjects() const;
    std::filesystem::path path_;
    std::optional<Dataset> bones_;
    MotionsFile file_;
    Subjects subjects_;
};

/// The label, from 0, in a name like S001C001P001R001A001, A001_7 or A001_front: the last A with three digits or more behind it, then
/// no letter. Nothing for other names.
std::optional<std::uint32_t> label_in(const std::string& name);

/// (K) lengths in metres for a body whose own are unknown: an adult's for NTU's 25 joints, else 0.2 each; the root's is 0.
std::vector<float> usual_bone_lengths(const Topology& topology);

}  // namespace actformer::ingest
