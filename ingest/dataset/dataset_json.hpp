// dataset.json: what a dataset is, in text.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ingest/dataset/dataset.hpp"

namespace actformer::ingest {

/// Format 1 differs in its shards' checksums, which are of the files' bytes: under "checksum" in place of "contents". From format 3 on
/// dataset.json has a checksum of its own, and one of every shard's metadata.
constexpr int dataset_format = 3;
constexpr int first_format_with_checksum = 3;

/// Everything dataset.json holds.
struct DatasetFile {
    DatasetHeader header;
    std::string settings;     ///< how the clips were cleaned
    std::string fingerprint;  ///< of the raw data
    std::vector<ShardEntry> shards;
    std::vector<std::string> remarks;  ///< what the ingest said of the data, a line each
};

std::string to_text(const DatasetFile& file);

/// Throws Error naming `path` and the key at fault, or where its checksum is wrong. To edit it, take out its members "checksum" and "program".
DatasetFile read_dataset_json(const std::filesystem::path& path);

/// {"data": .., "skeleton": ..}; what is not told is left out.
nlohmann::ordered_json to_json(const DataOrigin& origin);

nlohmann::ordered_json to_json(const ShardEntry& shard);
ShardEntry shard_from_json(const nlohmann::json& json);

/// Whether `file` leads to something below the folder it is told of: no way up, and not from the root.
bool lies_below(const std::filesystem::path& file);

}  // namespace actformer::ingest
