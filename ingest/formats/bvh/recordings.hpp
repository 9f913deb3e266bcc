// Recordings out of BVH files, and out of .amc files with the .asf skeletons that stand beside them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ingest/formats/asf/asf_file.hpp"
#include "ingest/formats/format.hpp"
#include "ingest/formats/skeletal/recording.hpp"

namespace actformer::ingest {

class Recordings {
  public:
    /// `asf` is the skeleton of .amc files that have none of their own, or empty. Throws Error where it cannot be read.
    explicit Recordings(const std::string& asf);

    static bool is_asf(const RawText& raw);
    static bool is_amc(const RawText& raw);

    /// Takes in an .asf file. One thread at a time, and none while another reads.
    void add_asf(const RawText& raw);

    /// An .amc's own skeleton has been taken in: that of its name, SUBJECT.asf for SUBJECT_TRIAL.amc.
    bool has_own_asf(const RawText& amc) const;

    /// A recording a person. An .amc's skeleton is its own; else the one that was given; else the only one in its folder.
    std::variant<std::vector<Recording>, Rejection> read(const RawText& raw) const;

  private:
    using Parsed = std::variant<AsfSkeleton, Rejection>;
    const Parsed* own_asf(const std::string& path) const;
    const Parsed* asf_of(const std::string& path) const;

    std::map<std::string, Parsed> by_path_;  ///< as path_for_names has it
    std::optional<Parsed> given_;
};

}  // namespace actformer::ingest
