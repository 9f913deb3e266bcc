// Features files: in the making, where rows come in any order and the file appears when all are there; and read.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/hdf5/writer.hpp"
#include "eval/metrics/samples.hpp"

namespace actformer::eval {

class FeaturesFile {
  public:
    /// Written beside `path` until finish(). Throws Error where that cannot be.
    FeaturesFile(const std::filesystem::path& path, std::uint64_t sequences, std::uint64_t features,
                 std::uint64_t classes);

    /// `rows` consecutive sequences from `first` on: features (rows, features), logits (rows, classes), none where there
    /// are no classes.
    void add(std::uint64_t first, std::span<const float> features, std::span<const float> logits);

    void names(const std::vector<std::string>& names);
    void labels(const std::vector<std::uint32_t>& labels);
    void note(const std::string& attribute, const std::string& value);
    void frames(std::uint32_t shortest, std::uint32_t longest);  ///< of the sequences

    /// Throws Error where not all of it could be written.
    void finish();

  private:
    std::uint64_t sequences_, features_, classes_;
    hdf5::Writer writer_;
};

struct StoredFeatures {
    Samples samples;                          ///< classes: as many as logits, or up to the highest label
    std::vector<std::string> names;           ///< (n), or empty where the file has none
    std::uint32_t shortest = 0, longest = 0;  ///< frames of the sequences; 0 where the file does not tell
};

/// Reads a features file of this program or another's: `features` (n, d), `labels` (n), and where they are there `logits`
/// (n, classes) and `names` (n), numbers of any type. Throws Error naming the file for what is missing, damaged, of another
/// shape, not finite, or no label, and for logits of more classes than a Confusion has.
StoredFeatures read_features(const std::filesystem::path& path);

/// Whether a file holds features that this program wrote: they name the view of the motions that they are of. Throws Error where it is no
/// HDF5 file.
bool is_own_features(const std::filesystem::path& path);

/// Whether a file that this program keeps for itself is there, and has the checksum that it was written with.
bool is_as_written(const std::filesystem::path& path);

}  // namespace actformer::eval
