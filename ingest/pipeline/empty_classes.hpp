// Classes that end up without a clip, dropped from a dataset whose shards are written already.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ingest/dataset/dataset_json.hpp"

namespace actformer::ingest {

/// Keeps of the classes those in `labels` (labels that clips have) and renumbers the labels in the shards, which lie in `folder`.
/// Each shard is replaced whole; one that an interrupted call has renumbered, as its checksum tells, is left as it is. Before the first
/// is replaced `announce` is told of each shard's path and the checksum that its bytes will have.
/// Returns the names of the classes dropped.
std::vector<std::string> drop_empty_classes(
    DatasetFile& file, const std::set<std::uint32_t>& labels, const std::filesystem::path& folder,
    const std::function<void(const std::map<std::filesystem::path, std::string>&)>& announce);

}  // namespace actformer::ingest
