// dataset.json: what a dataset is, in text.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ingest/dataset/dataset.hpp"

namespace actformer::ingest {

constexpr int dataset_format = 1;

/// Everything dataset.json holds.
struct DatasetFile {
    DatasetHeader header;
    std::string settings;     ///< how the clips were cleaned
    std::string fingerprint;  ///< of the raw data
    std::vector<ShardEntry> shards;
};

std::string to_text(const DatasetFile& file);

/// Throws Error naming `path` and the key at fault.
DatasetFile read_dataset_json(const std::filesystem::path& path);

nlohmann::ordered_json to_json(const ShardEntry& shard);
ShardEntry shard_from_json(const nlohmann::json& json);

}  // namespace actformer::ingest
