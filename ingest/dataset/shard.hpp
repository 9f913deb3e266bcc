// One shard: an HDF5 file with many clips' motions and metadata.
//
//   motion             (frames, P, nodes, numbers) float32   all clips one after the other, as their representation has them; chunked, checksummed
//   clip/offset        (clips)           uint64    first frame
//   clip/length        (clips)           uint32    frames
//   clip/label         (clips)           uint32
//   clip/name          (clips)           string
//   clip/FIELD         (clips)           string    metadata for the splits, as in clip/performer
//   clip/bone_length   (clips, P, joints) float32  metres, 0 for the root
//
// The file's checksums stand in dataset.json.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/hdf5/writer.hpp"
#include "ingest/dataset/dataset.hpp"
#include "kernels/cleaning.hpp"

namespace actformer::ingest {

/// A shard's file in memory.
struct ShardImage {
    hdf5::Writer file;
    std::string_view bytes;  ///< of the file
    std::string contents;    ///< their checksum
    std::string metadata;    ///< that of all but the motion
};

/// Gathers clips in memory and becomes a file in one go.
class ShardBuilder {
  public:
    explicit ShardBuilder(const DatasetHeader& header) : header_(&header) {}

    /// Clips in order; cleaned.motion holds their frames one after the other, (frames, P, nodes, numbers).
    void add(const std::vector<Clip>& clips, kernels::CleanedBatch cleaned);

    std::size_t clips() const { return clips_.size(); }
    std::uint64_t frames() const { return frames_; }
    std::uint64_t bytes() const;  ///< of motion, about
    bool empty() const { return clips_.empty(); }

    /// Makes the file in `memory`. It says what it was made from. The motions are let go as soon as they are in the file, so that the
    /// next shard can have their memory: only once, therefore.
    ShardImage image(hdf5::FileMemory& memory, const std::string& settings, const std::string& fingerprint);

  private:
    const DatasetHeader* header_;
    std::vector<Clip> clips_;
    std::vector<kernels::CleanedBatch> pieces_;  ///< as they came: joining them would copy most of the shard
    std::uint64_t frames_ = 0;
};

/// Metadata of every clip in the shard, `shard` being its number. `metadata`: the checksum that it must have; empty where that is not
/// known. Throws Error for a damaged or foreign file.
std::vector<Clip> read_clips(const std::filesystem::path& path, const DatasetHeader& header,
                             std::uint32_t shard, const std::string& metadata = {});

/// "shard-00012.h5"
std::string shard_name(std::size_t number);

}  // namespace actformer::ingest
