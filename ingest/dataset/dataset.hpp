// A dataset: a folder with dataset.json and checksummed shards. Read-only; ingest() makes one.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/body_model.hpp"
#include "ingest/dataset/origin.hpp"
#include "ingest/dataset/split.hpp"

namespace actformer::hdf5 {
class Reader;
}

namespace actformer::ingest {

inline constexpr std::size_t most_fields = 1000;  ///< of a clip: each is a column in every shard

/// What dataset.json says, shards apart.
struct DatasetHeader {
    std::string name;  ///< as in "ntu-1p"
    Representation representation;
    Topology topology;
    std::vector<float> rest;  ///< (joints, 3) metres, as in BodyModel; of rotations, else empty
    DataOrigin origin;
    std::uint32_t persons = 1;
    double fps = 30;
    bool centre_windows =
        false;  ///< windows show the root relative to their own mean: clips wander further than a window
    std::vector<std::string> classes;  ///< label i is classes[i]
    std::vector<std::string> fields;   ///< metadata of every clip that splits may ask for, as in "performer"
    std::vector<Split> splits;

    std::uint32_t nodes() const { return representation.nodes(topology); }
    std::size_t frame_values() const {  ///< numbers of a frame, (persons, nodes, numbers)
        return std::size_t{persons} * nodes() * representation.numbers();
    }
};

/// Where a clip is and what is known of it.
struct Clip {
    std::string name;
    std::uint32_t label = 0;
    std::uint32_t shard = 0;
    std::uint64_t offset = 0;  ///< first frame within the shard
    std::uint32_t frames = 0;
    std::vector<std::string> fields;  ///< values, as DatasetHeader::fields names them
};

struct ShardEntry {
    std::string file;
    std::string checksum;  ///< of its contents (hdf5::Contents)
    std::uint64_t bytes = 0, clips = 0, frames = 0;
    bool checksum_of_bytes = false;  ///< format 1: of the file as it was written
    std::string metadata{};          ///< the checksum of all but the motion; empty before format 3
};

/// Compares all data with their checksums: dataset.json and the metadata at once, a motion's chunks when it is asked for. For one thread at
/// a time.
class Dataset {
  public:
    /// Reads dataset.json and the clips' metadata. Throws Error naming the file, what is wrong and the remedy.
    explicit Dataset(const std::filesystem::path& folder);

    const std::filesystem::path& folder() const { return folder_; }
    const DatasetHeader& header() const { return header_; }
    const std::string& fingerprint() const { return fingerprint_; }  ///< of the raw data it came from
    const std::vector<ShardEntry>& shards() const { return shards_; }
    const std::vector<std::string>& remarks() const { return remarks_; }  ///< of the ingest, a line each
    const std::vector<Clip>& clips() const { return clips_; }

    /// "all", and those of the header.
    std::vector<std::string> split_names() const;

    /// Indices into clips() of those in split `name`; "all" is every clip. Throws Error naming the splits there are.
    std::vector<std::size_t> split(const std::string& name) const;

    /// Index of the clip called `name`; none where there is no such clip.
    std::optional<std::size_t> find(const std::string& name) const;

    Motion motion(std::size_t clip) const;
    std::vector<float> bone_length(std::size_t clip) const;  ///< (persons, joints) metres
    BodyModel body(std::size_t clip) const;                  ///< what gives its joint positions

  private:
    const hdf5::Reader& shard_of(const Clip& clip) const;

    std::filesystem::path folder_;
    DatasetHeader header_;
    std::string fingerprint_;
    std::vector<ShardEntry> shards_;
    std::vector<std::string> remarks_;
    std::vector<Clip> clips_;
    std::vector<std::size_t> first_clip_;  ///< of each shard
    std::map<std::string, std::size_t> by_name_;
    mutable std::shared_ptr<hdf5::Reader> open_;  ///< the shard read last: clips are mostly read in order
    mutable std::uint32_t open_shard_ = 0;
};

struct Verification {
    std::vector<std::string> faults;  ///< a line each; none where all is well
    bool checksums_of_bytes =
        false;  ///< written by format 1: they tell a file that was opened for writing from one that was not
};

/// Recomputes every checksum and checks every offset and number of the dataset in `folder`. Throws Error where dataset.json
/// itself cannot be read.
Verification verify_dataset(const std::filesystem::path& folder);

/// Folders of the datasets at `path`: itself, or those directly inside (as `ingest ntu` lays them out). Throws Error where
/// there are none.
std::vector<std::filesystem::path> datasets_at(const std::filesystem::path& path);

/// The one of them. Throws Error where there are none or several.
std::filesystem::path one_dataset_at(const std::filesystem::path& path);

/// The checksum of dataset.json, which has those of its shards: another one where any motion, label or split differs. Throws Error where
/// there is no dataset in `folder`.
std::string dataset_checksum(const std::filesystem::path& folder);

}  // namespace actformer::ingest
