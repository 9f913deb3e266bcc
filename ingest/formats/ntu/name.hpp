// Names of NTU RGB+D clips: SsssCcccPpppRrrrAaaa.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace actformer::ingest {

struct NtuName {
    int setup = 0, camera = 0, performer = 0, replication = 0;
    int action = 0;  ///< 1..120
};

/// What a name tells of a clip, as DatasetHeader::fields has it: setup, camera, performer, replication, action; and the values.
std::vector<std::string> ntu_fields();
std::vector<std::string> ntu_fields_of(const NtuName& name);

/// Nothing where `stem` is not spelt like one or the action is not one of 1..120.
std::optional<NtuName> parse_ntu_name(std::string_view stem);

/// Names in a missing-skeleton list: one a line, with or without header lines and ".skeleton". Throws Error where the
/// file cannot be read or holds no name.
std::unordered_set<std::string> read_missing_list(const std::filesystem::path& path);

}  // namespace actformer::ingest
